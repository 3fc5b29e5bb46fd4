"""Synthetic runs of duels with prescribed results."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from stepaside.core.poses import Array
from stepaside.games.game import Outcome
from stepaside.games.game_settings import GameSettings, duel
from stepaside.games.run import Run
from stepaside.games.summary import PlayerSummary, Summary, TheorySummary
from stepaside.games.trajectory import Trajectory

CIRCLE = TheorySummary(
    radius_m=0.6366, distance_m=0.9003, relative_orientation_deg=90.0
)


def figures(**changes: Any) -> Summary:
    """Figures of a duel without a trigger."""
    told = Summary(
        distance_m=1.0,
        relative_orientation_deg=90.0,
        min_distance_m=0.9,
        real_time_factor=1.0,
        players={n: PlayerSummary(0.0, None) for n in ("pursuer", "evader")},
        theory=TheorySummary(),
    )
    return replace(told, **changes)


def run_of(
    times: Array,
    tracks: Mapping[str, Trajectory],
    *,
    settings: GameSettings | None = None,
    name: str = "synthetic",
    outcome: Outcome = Outcome.COMPLETED,
    message: str = "played 18.00 s",
    **changes: Any,
) -> Run:
    """Run with these tracks.

    Args:
        times: Of the samples, in [s].
        tracks: By name of the player.
        settings: What decided it.
        name: What it is called.
        outcome: How it ended.
        message: What ended it.
        changes: Of the figures.
    """
    return Run(
        name=name,
        settings=settings or duel(),
        outcome=outcome,
        message=message,
        duration=float(times[-1]),
        times=times,
        tracks=tracks,
        summary=figures(**changes),
    )


def changed(run: Run, **figures: Any) -> Run:
    """The same run with other figures."""
    return replace(run, summary=replace(run.summary, **figures))


def drifted(run: Run, times: Array) -> Run:
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
