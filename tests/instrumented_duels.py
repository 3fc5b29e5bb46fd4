"""Synthetic instrumented duels: two robots on the circle of the theory."""

from dataclasses import replace
from math import pi, radians, sin
from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from stepaside.core.poses import Array
from stepaside.games.game_settings import GameSettings, duel
from stepaside.games.outcome import Outcome
from stepaside.games.player_settings import PLAYERS
from stepaside.games.run import Run
from stepaside.games.trajectory import Trajectory
from stepaside.studies.game_claims import InstrumentedDuel, WalkedPlan

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
