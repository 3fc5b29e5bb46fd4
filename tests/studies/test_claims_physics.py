"""Test the claims in physics: each fails under a synthetic fault."""

from collections.abc import Callable, Mapping, Sized
from dataclasses import replace
from math import isnan, pi, radians, sin
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
from stepaside.studies.claims import SEEDED, Claim, Readings, load_claims
from stepaside.studies.game_claims import (
    InstrumentedDuel,
    WalkedPlan,
    play_instrumented,
)

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


# --- the duel of Fig. 5 ---------------------------------------------------


def converge_late(duel: InstrumentedDuel) -> InstrumentedDuel:
    """Let the robots reach the circle only at the end."""
    late = duel.run.times < 27.0
    return changed(
        duel, evader_torso=lambda t: t * np.where(late, 2, 1)[:, None]
    )


def shift_replans(by: float) -> Fault:
    """Shift the replans of the evader by a time, in [s]."""

    def fault(duel: InstrumentedDuel) -> InstrumentedDuel:
        walked = duel.plans["evader"]
        later = tuple(
            plan._replace(first_sent_time=plan.first_sent_time + by)
            for plan in walked
        )
        return replace(duel, plans={**duel.plans, "evader": later})

    return fault


def replan_rarely(duel: InstrumentedDuel) -> InstrumentedDuel:
    """Walk every plan for fifteen steps, beyond its arc."""
    plans = {name: walked[::15] for name, walked in duel.plans.items()}
    return replace(duel, plans=plans)


def walk_one_plan_long(duel: InstrumentedDuel) -> InstrumentedDuel:
    """Walk a single plan beyond its arc."""
    walked = duel.plans["evader"]
    plans = {**duel.plans, "evader": walked[:5] + walked[20:]}
    return replace(duel, plans=plans)


def change_reference(change: Callable[[Array], Array]) -> Fault:
    """Change the evader's reference from a replan on."""

    def fault(duel: InstrumentedDuel) -> InstrumentedDuel:
        started = duel.plans["evader"][7].start_time
        since = np.maximum(duel.ticks - started, 0.0)[:, None]
        moved = duel.references["evader"] + change(since)
        return replace(duel, references={**duel.references, "evader": moved})

    return fault


def change_loads(change: Callable[[Array], Array]) -> Fault:
    """Change the foot loads of the evader."""

    def fault(duel: InstrumentedDuel) -> InstrumentedDuel:
        loads = change(duel.loads["evader"].copy())
        return replace(duel, loads={**duel.loads, "evader": loads})

    return fault


def evader_stands(duel: InstrumentedDuel) -> InstrumentedDuel:
    """Let the evader stand."""
    still = standing_duel()
    return replace(
        duel,
        loads={**duel.loads, "evader": still.loads["evader"]},
        plans={**duel.plans, "evader": ()},
    )


def limp(loads: Array) -> Array:
    """Hold the left foot up for another 0.1 s at each step."""
    air = loads[:, 0] == 0.0
    for shift in range(1, 26):
        loads[shift:, 0][air[:-shift]] = 0.0
    return loads


CIRCLE: dict[str, tuple[Fault, ...]] = {
    "settled": (converge_late,),
    "pursuer_radius": (
        lambda d: changed(d, pursuer_torso=lambda t: t * (1.05, 1.05, 1.0)),
        lambda d: changed(d, pursuer_torso=lambda t: t * (0.95, 0.95, 1.0)),
        lambda d: changed(d, pursuer_torso=lambda t: t * (0.0, 0.0, 1.0)),
    ),
    "evader_radius": (
        lambda d: changed(d, evader_torso=lambda t: t * (1.05, 1.05, 1.0)),
        lambda d: changed(d, evader_torso=lambda t: t * (0.2, 0.2, 1.0)),
    ),
    "one_circle": (
        lambda d: changed(d, evader_torso=lambda t: t + (0.03, 0.03, 0.0)),
    ),
    "distance": (
        lambda d: changed(d, evader_torso=lambda t: 1.2 * t),
        lambda d: changed(d, evader_torso=lambda t: 0.8 * t),
    ),
    "orientation": (
        lambda d: changed(d, evader_torso=lambda t: t + (0, 0, 0.1)),
        lambda d: changed(d, evader_torso=lambda t: t - (0, 0, 0.1)),
        lambda d: changed(d, evader_torso=lambda t: t * (1, 1, -1)),
    ),
    "same_speed": (
        lambda d: changed(d, evader_torso=lambda t: 0.9 * t),
        lambda d: changed(d, evader_torso=lambda t: 0.0 * t),
        lambda _: standing_duel(),
    ),
    "landings": (
        change_loads(limp),
        change_loads(lambda loads: 0.0 * loads + 26.0),
        change_loads(lambda loads: 0.0 * loads),
        evader_stands,
    ),
    "both_feet": (
        shift_replans(0.15),
        shift_replans(-0.2),
        lambda d: replace(
            d, plans={name: p[::2] for name, p in d.plans.items()}
        ),
        evader_stands,
    ),
    "at_its_end": (shift_replans(-0.08), evader_stands),
    "straight_part": (replan_rarely, walk_one_plan_long, evader_stands),
    "place_jump": (
        change_reference(lambda t: np.where(t > 0.0, 1e-6, 0.0)),
        evader_stands,
    ),
    "velocity_jump": (
        change_reference(lambda t: 1e-4 * t),
        evader_stands,
    ),
}


@pytest.mark.parametrize("key", claims("humanoids"))
def test_every_claim_on_the_circle_holds_and_fails(key: str) -> None:
    claim = claims("humanoids")[key]
    duel = walked_duel()
    assert claim.holds([read.read_circle(duel)[key]])
    for fault in CIRCLE[key]:
        assert not claim.holds([read.read_circle(fault(duel))[key]])


@pytest.mark.parametrize("outcome", [Outcome.FALL, Outcome.CONTACT])
def test_interrupted_duel_has_no_circle(outcome: Outcome) -> None:
    found = read.read_circle(walked_duel(outcome=outcome))
    for key in ("settled", "pursuer_radius", "distance", "orientation"):
        assert isnan(found[key])


# --- the durations --------------------------------------------------------


def sways(tilt: float = radians(6.0), slide: float = 0.02) -> InstrumentedDuel:
    """Return a duel with slipping feet and swaying torsos."""
    return walked_duel(tilt=tilt, slide=slide)


def falls(
    tilt: float = radians(50.0), duration: float = 4.0
) -> InstrumentedDuel:
    return walked_duel(duration, outcome=Outcome.FALL, tilt=tilt)


Duels = tuple[InstrumentedDuel, ...]


SWAYS: dict[str, Duels] = {
    "printed_slide": (walked_duel(), sways(slide=0.0015)),
    "printed_tilt": (walked_duel(), sways(tilt=radians(2.9))),
}


WALKS: dict[str, Duels] = {
    "upright_for": (walked_duel(29.0), falls()),
    "tilt": (walked_duel(tilt=radians(12.0)), falls()),
    "distance": (
        standing_duel(),
        changed(walked_duel(), evader_torso=lambda t: 0.0 * t),
        walked_duel(speed=0.1),
    ),
    "speed": (
        standing_duel(),
        walked_duel(speed=0.1),
        changed(walked_duel(), evader_torso=lambda t: 0.9 * t),
    ),
}


@pytest.mark.parametrize("key", claims("durations"))
def test_every_claim_on_the_durations_holds_and_fails(key: str) -> None:
    claim = claims("durations")[key]

    def reading(printed: InstrumentedDuel, walked: InstrumentedDuel) -> float:
        return read.read_durations(printed, walked)[key]

    assert claim.holds([reading(sways(), walked_duel())])
    faults = SWAYS.get(key, ()) + WALKS.get(key, ())
    assert faults
    for printed in SWAYS.get(key, ()):
        assert not claim.holds([reading(printed, walked_duel())])
    for walked in WALKS.get(key, ()):
        assert not claim.holds([reading(sways(), walked)])


# --- the slippery floor ---------------------------------------------------

SLIPS = walked_duel(radius=0.9 * RADIUS, speed=0.06, slide=0.02)


NO_SLIP: dict[str, Duels] = {
    "slide": (walked_duel(radius=0.5, speed=0.06, slide=0.001),),
    "slower": (walked_duel(radius=0.5, speed=0.08, slide=0.02),),
    "smaller": (walked_duel(radius=0.7, speed=0.06, slide=0.02),),
}


ENDED = walked_duel(
    radius=0.5, speed=0.06, slide=0.02, outcome=Outcome.CONTACT
)


ONE_STANDS = (
    changed(SLIPS, pursuer_torso=lambda t: t * (0.0, 0.0, 1.0)),
    changed(SLIPS, evader_torso=lambda t: t * (0.0, 0.0, 1.0)),
)


@pytest.mark.parametrize("key", claims("slip"))
def test_every_claim_on_slip_holds_and_fails(key: str) -> None:
    claim, grip = claims("slip")[key], walked_duel()
    assert claim.holds([read.read_slip(grip, SLIPS)[key]])
    for fault in (*NO_SLIP[key], ENDED, standing_duel(), *ONE_STANDS):
        assert not claim.holds([read.read_slip(grip, fault)[key]])
    for fault in (ENDED, *ONE_STANDS):
        assert isnan(read.read_slip(fault, SLIPS)[key])


# --- measures -------------------------------------------------------------


# --- real duels, for a few seconds ----------------------------------------


def holding(job: str, found: Readings) -> set[str]:
    assert set(found) == set(claims(job))
    return {k for k, c in claims(job).items() if c.holds([found[k]])}


def test_claims_on_replanning_hold_in_a_short_duel() -> None:
    replanning = {
        *("landings", "both_feet", "at_its_end"),
        *("straight_part", "place_jump", "velocity_jump"),
    }
    duel = play_instrumented(read.walk_settings(1, duration=5.0))
    assert replanning <= holding("humanoids", read.read_circle(duel))


def test_claims_on_durations_hold_in_short_duels(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(read, "WALK_TIME", 6.0)
    found = read.measure_durations(1)
    assert {"printed_slide", "printed_tilt", "tilt"} <= holding(
        "durations", found
    )
    assert found["upright_for"] == pytest.approx(6.0)


def test_claims_on_slip_hold_in_short_duels(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(read, "SLIP_TIME", 5.0)
    assert {"slide", "slower"} <= holding("slip", read.measure_slip(1))


def test_settling_is_required_before_the_last_third() -> None:
    """Radii and distance are measured over the last third."""
    third = read.CIRCLE_TIME * 2.0 / 3.0
    assert claims("humanoids")["settled"].expected == third


def test_every_claim_in_physics_has_a_fault() -> None:
    faults: dict[str, Mapping[str, Sized]] = {
        "humanoids": CIRCLE,
        "durations": SWAYS | WALKS,
        "slip": NO_SLIP,
    }
    # Claims on games in rooms are tested in test_game_claims.
    assert set(faults) == set(SEEDED) - {"evading", "rooms"}
    for name, by_key in faults.items():
        assert set(by_key) == set(claims(name))
        assert all(by_key.values())
