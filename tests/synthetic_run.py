"""Synthetic runs of duels with prescribed results."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from stepaside.core.poses import Array
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.duel_summary import (
    DuelSummary,
    PlanTimes,
    PlayerSummary,
    StartSummary,
    TheorySummary,
)
from stepaside.games.outcome import Outcome
from stepaside.games.run import DuelRun, Run
from stepaside.games.trajectory import Trajectory

NO_THEORY = TheorySummary(None, False, None, None, None)


def figures(**changes: Any) -> DuelSummary:
    """Figures of a duel without a trigger."""
    told = DuelSummary(
        seed=7,
        start=StartSummary(1.0, 0.0, 0.0),
        triggered_at_s=None,
        triggered_at_distance_m=None,
        distance_m=1.0,
        relative_orientation_deg=90.0,
        min_distance_m=0.9,
        converged_at_s=None,
        replans=0,
        max_com_velocity_jump_m_s=0.0,
        min_zmp_margin_m=None,
        theory=NO_THEORY,
        plan_time_us=PlanTimes(None, None),
        real_time_factor=1.0,
        pursuer=PlayerSummary(None),
        evader=PlayerSummary(None),
    )
    return replace(told, **changes)


def run_of(
    times: Array,
    tracks: Mapping[str, Trajectory],
    *,
    settings: DuelSettings | None = None,
    name: str = "synthetic",
    outcome: Outcome = Outcome.COMPLETED,
    message: str = "played 18.00 s",
    stills: Any = None,
    **changes: Any,
) -> DuelRun:
    """Run with these tracks.

    Args:
        times: Of the samples, in [s].
        tracks: By name of the player.
        settings: What decided it.
        name: What it is called.
        outcome: How it ended.
        message: What ended it.
        stills: What was seen, by player and camera.
        changes: Of the figures.
    """
    return DuelRun(
        name=name,
        settings=settings or DuelSettings(),
        outcome=outcome,
        message=message,
        duration=float(times[-1]),
        times=times,
        tracks=tracks,
        summary=figures(**changes),
        stills=stills or {},
    )


def changed(run: DuelRun, **figures: Any) -> DuelRun:
    """The same run with other figures."""
    return replace(run, summary=replace(run.summary, **figures))


def drifted(run: DuelRun, times: Array) -> DuelRun:
    """The same run at other times, in which both players slide apart.

    Args:
        run: The run.
        times: Of its samples, in [s].
    """
    tracks = {}
    for name, side in (("pursuer", 1.0), ("evader", -1.0)):
        track = run.tracks[name]
        assert track.qpos is not None
        tracks[name] = replace(
            track,
            torso=_slid(track.torso, side, times),
            com=_slid(track.com, side, times),
            qpos=_slid(track.qpos, side, times),
        )
    return replace(run, times=times, tracks=tracks)


def _slid(rows: Array, side: float, times: Array) -> Array:
    """Rows whose first two columns move on with time."""
    moved = rows.copy()
    moved[:, 0] += (side * times).astype(rows.dtype)
    moved[:, 1] -= (0.5 * side * times).astype(rows.dtype)
    return moved


def check_same(run: Run, other: Run) -> None:
    """Compare all of two runs that a folder keeps, but for their names."""
    for key in ("settings", "outcome", "message", "duration", "summary"):
        assert getattr(run, key) == getattr(other, key), key
    arrays, others = run.arrays(), other.arrays()
    assert arrays.keys() == others.keys()
    for name, values in others.items():
        np.testing.assert_array_equal(arrays[name], values)
        assert arrays[name].dtype == values.dtype
