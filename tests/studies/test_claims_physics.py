"""Test the claims in physics: each fails under a synthetic fault."""

from collections.abc import Callable
from dataclasses import replace
from math import pi, radians, sin
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.game import Outcome
from stepaside.games.game_settings import GameSettings, duel
from stepaside.games.player_settings import PLAYERS
from stepaside.games.run import Run
from stepaside.games.trajectory import Trajectory
from stepaside.studies import game_claims as read
from stepaside.studies.claims import Claim, Readings, load_claims
from stepaside.studies.game_claims import (
    InstrumentedDuel,
    WalkedPlan,
    play_instrumented,
)
from stored_values import compare_stored, content_of

RADIUS = 4.0 * 0.1 / (pi * 0.2)


WEIGHT = 52.0  # of a robot, in [N]


LATE, AIR = 0.02, 0.36  # lift-off after a plan begins, time off the floor, [s]


def walked_duel(
    duration: float = 30.0,
    *,
    radius: float = RADIUS,
    speed: float = 0.04 / 0.547,
    slide: float = 0.002,
    tilt: float = radians(1.0),
    outcome: Outcome = Outcome.COMPLETED,
) -> InstrumentedDuel:
    """Return a duel on the circle from its begin.

    Args:
        duration: Simulated time, in [s].
        radius: Radius of the circle, in [m].
        speed: Speed of both robots, in [m/s].
        slide: Slip of a stance foot per step, in [m].
        tilt: Tilt of both torsos at the end, in [rad].
        outcome: Outcome of the duel.
    """
    settings = duel(duration=duration)
    times = np.arange(0.0, duration + 1e-9, 0.02)
    ticks = np.arange(round(duration / 0.004), dtype=np.float64) * 0.004
    tracks: dict[str, Trajectory] = {}
    quaternion = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    quaternion[-1, 1] = sin(0.5 * tilt)
    plans = _plans(settings, duration)
    loads, feet = _feet(ticks, plans, slide)
    along = speed / radius * times
    for name, ahead, heading in (
        ("pursuer", 0.0, pi / 2),
        ("evader", pi / 2, 0.0),  # it walks backward
    ):
        angle = along + ahead
        position = radius * np.column_stack([np.cos(angle), np.sin(angle)])
        level = 0.0 * along
        tracks[name] = Trajectory(
            com=np.column_stack([position, 0.268 + level]),
            torso=np.column_stack([position, along + heading]),
            qpos=np.column_stack([position, 0.33 + level, quaternion]),
        )
    sway = np.column_stack([0.07 * ticks, 0.03 * np.sin(5.0 * ticks)])
    return InstrumentedDuel(
        run=_run(settings, outcome, duration, times, tracks),
        ticks=ticks,
        loads={name: loads.copy() for name in PLAYERS},
        feet={name: feet.copy() for name in PLAYERS},
        references={name: sway.copy() for name in PLAYERS},
        plans=dict.fromkeys(PLAYERS, plans),
    )


def _run(
    settings: GameSettings,
    outcome: Outcome,
    duration: float,
    times: Array,
    tracks: dict[str, Trajectory],
) -> Run:
    """Return a run without summary."""
    run = SimpleNamespace(
        settings=settings,
        outcome=outcome,
        duration=duration,
        times=times,
        tracks=tracks,
    )
    return cast(Run, run)


def _plans(settings: GameSettings, duration: float) -> tuple[WalkedPlan, ...]:
    """Return one plan per step, the first from standing."""
    gait = settings.gait
    begins = gait.start_support + gait.step_duration * np.arange(1.0, 1e3)
    walked = begins[begins < duration - gait.step_duration].tolist()
    return (
        WalkedPlan(0.0, 0.0, True),
        *(WalkedPlan(t, 0.004 * np.ceil(t / 0.004), False) for t in walked),
    )


def _feet(
    ticks: Array, plans: tuple[WalkedPlan, ...], slide: float
) -> tuple[Array, Array]:
    """Return loads and positions of the feet, left foot first."""
    loads = np.full((len(ticks), 2), 0.5 * WEIGHT)
    feet = np.zeros((len(ticks), 2, 2))
    for number, plan in enumerate(plans):
        lift = plan.start_time + LATE + (0.8 if plan.from_standing else 0.0)
        air = (ticks >= lift) & (ticks < lift + AIR)
        side = number % 2
        loads[air, side], loads[air, 1 - side] = 0.0, WEIGHT
        # The foot swings by 40 mm while the other one slips.
        feet[ticks >= lift + AIR, side, 0] += 0.04
        feet[ticks >= lift + 0.5 * AIR, 1 - side, 0] += slide
    return loads, feet


def changed(duel: InstrumentedDuel, **arrays: Any) -> InstrumentedDuel:
    """Return the duel with trajectory arrays mapped by functions.

    Args:
        duel: The duel.
        arrays: Functions by player and array, as in ``evader_torso``.
    """
    run = duel.run
    tracks = dict(run.tracks)
    for full_name, change in arrays.items():
        player, name = full_name.split("_", 1)
        track = tracks[player]
        values = change(getattr(track, name).copy())
        tracks[player] = replace(track, **{name: values})
    changed_run = _run(
        run.settings, run.outcome, run.duration, run.times, tracks
    )
    return replace(duel, run=changed_run)


def standing_duel() -> InstrumentedDuel:
    """Return a duel of two robots that never lift a foot."""
    still = walked_duel(speed=0.0)
    loads = np.full_like(still.loads["pursuer"], 0.5 * WEIGHT)
    return replace(
        still,
        loads=dict.fromkeys(PLAYERS, loads),
        plans=dict.fromkeys(PLAYERS, ()),
    )


Fault = Callable[[InstrumentedDuel], InstrumentedDuel]


def claims(job: str) -> dict[str, Claim]:
    return load_claims()[job]


def holding(job: str, found: Readings) -> set[str]:
    assert set(found) == set(claims(job))
    return {k for k, c in claims(job).items() if c.holds([found[k]])}


def skewed(right: InstrumentedDuel) -> InstrumentedDuel:
    """The duel with wrong paths, and an evader that limps and replans late.

    Its references jump from a replan on, and a plan is walked for too long.
    """
    duel = changed(
        right,
        pursuer_torso=lambda t: t * (1.04, 0.97, 1.01) + (0.02, 0.0, 0.0),
        evader_torso=lambda t: t * (0.93, 0.91, -1.0) + (0.0, 0.03, 0.1),
    )
    walked = duel.plans["evader"]
    later = tuple(
        plan._replace(first_sent_time=plan.first_sent_time + 0.15)
        for plan in walked[:5] + walked[20:]
    )
    since = np.maximum(duel.ticks - walked[7].start_time, 0.0)[:, None]
    kinked = duel.references["evader"] + 1e-4 * since + 1e-6 * (since > 0.0)
    loads = duel.loads["evader"].copy()
    air = loads[:, 0] == 0.0
    for shift in range(1, 26):  # the left foot lands 0.1 s later
        loads[shift:, 0][air[:-shift]] = 0.0
    return replace(
        duel,
        plans={**duel.plans, "evader": later},
        references={**duel.references, "evader": kinked},
        loads={**duel.loads, "evader": loads},
    )


DUELS: dict[str, Callable[[], InstrumentedDuel]] = {
    "right": walked_duel,
    "skewed": lambda: skewed(walked_duel()),
    "slipping": lambda: skewed(walked_duel(tilt=0.1, slide=0.02, speed=0.06)),
    "standing": standing_duel,
    "short": lambda: walked_duel(4.0, tilt=0.8, outcome=Outcome.FALL),
    "ended": lambda: walked_duel(outcome=Outcome.CONTACT),
}


@pytest.mark.parametrize("name", DUELS)
def test_readings_of_a_duel_are_those_that_are_stored(name: str) -> None:
    duel, right = DUELS[name](), walked_duel()
    found: list[str | float] = []
    for job, values in (
        ("humanoids", read.read_circle(duel)),
        ("durations", read.read_durations(duel, right)),
        ("durations", read.read_durations(right, duel)),
        ("slip", read.read_slip(right, duel)),
        ("slip", read.read_slip(duel, right)),
    ):
        found += [job, *sorted(holding(job, values)), *content_of(values)]
    if name == "right":
        assert holding("humanoids", read.read_circle(duel)) == set(
            claims("humanoids")
        )
    compare_stored("claims.json", f"physics, {name}", found, 1e-4)


# --- real duels, for a few seconds ----------------------------------------


def test_claims_on_replanning_hold_in_a_short_duel() -> None:
    replanning = {
        *("landings", "both_feet", "at_its_end"),
        *("straight_part", "place_jump", "velocity_jump"),
    }
    duel = play_instrumented(read.walk_settings(1, duration=5.0))
    found = read.read_circle(duel)
    assert replanning <= holding("humanoids", found)
    compare_stored("claims.json", "5 s", content_of(found))


def test_claims_on_durations_hold_in_short_duels(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(read, "WALK_TIME", 6.0)
    found = read.measure_durations(1)
    assert {"printed_slide", "printed_tilt", "tilt"} <= holding(
        "durations", found
    )
    compare_stored("claims.json", "6 s", content_of(found))


def test_claims_on_slip_hold_in_short_duels(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(read, "SLIP_TIME", 5.0)
    found = read.measure_slip(1)
    assert {"slide", "slower"} <= holding("slip", found)
    compare_stored("claims.json", "slip", content_of(found))


def test_settling_is_required_before_the_last_third() -> None:
    """Radii and distance are measured over the last third."""
    third = read.CIRCLE_TIME * 2.0 / 3.0
    assert claims("humanoids")["settled"].expected == third


def test_the_walking_speed_is_that_of_the_last_third() -> None:
    def late(rows: Array) -> Array:
        half = len(rows) // 2
        return np.concatenate([rows[:1].repeat(half, axis=0), rows[:-half]])

    walked = walked_duel()
    slow = changed(walked, evader_torso=late)
    found = read.walking_speed(slow, "evader")
    whole = read.walking_speed(walked, "evader")
    assert found == pytest.approx(whole, rel=1e-6)
