"""Evaluation of a recorded game: what its trajectories give."""

from itertools import combinations
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from ..core.constants import CAPTURE_DISTANCE
from ..core.poses import Array
from ..theory.unicycle.circles import fit_circle
from .run import Run
from .summary import PairSummary, PlayerSummary, Summary
from .trajectory import (
    angle_between,
    cycle_mean,
    distance_between,
    last_third,
)

MIN_TURN = 0.5  # of a path to which a circle can be fitted, in [rad]


def measure(run: Run, late: NDArray[np.bool_] | None = None) -> Summary:
    """Return the part of a summary that trajectories give.

    Means and circles are those of late samples, by default of the last
    third, shape (n,). The summary of the run is not used.
    """
    late = last_third(run.times) if late is None else late
    pairs = {
        (one, other): _pair(run, one, other, late)
        for one, other in combinations(run.players, 2)
    }
    facing = {frozenset(names) for names in run.opponents}
    closest = [p.closest_m for n, p in pairs.items() if frozenset(n) in facing]
    times = (pair.captured_at_s for pair in pairs.values())
    return Summary(
        distance_m=_mean(run.distance[late]),
        relative_orientation_deg=_mean(run.orientation[late]),
        min_distance_m=min(closest, default=None),
        captured_at_s=min((t for t in times if t is not None), default=None),
        players={name: _player(run, name, late) for name in run.players},
        pairs={" - ".join(names): pair for names, pair in pairs.items()},
    )


def _mean(values: Array) -> float | None:
    mean = float(values.mean()) if len(values) else np.nan
    return mean if isfinite(mean) else None


def _pair(
    run: Run, one: str, other: str, late: NDArray[np.bool_]
) -> PairSummary:
    first, second = run.tracks[one], run.tracks[other]
    apart = distance_between(first.torso, second.torso)
    closest = int(apart.argmin())
    opposed = bool({(one, other), (other, one)} & {*run.facing})
    caught = np.flatnonzero(opposed & (apart <= CAPTURE_DISTANCE))
    last = first.unicycle[late], second.unicycle[late]
    return PairSummary(
        closest_m=float(apart[closest]),
        closest_at_s=float(run.times[closest]),
        captured_at_s=float(run.times[caught[0]]) if len(caught) else None,
        distance_m=_mean(distance_between(*last)),
        angle_deg=_mean(np.degrees(angle_between(*last))),
    )


def _player(run: Run, name: str, late: NDArray[np.bool_]) -> PlayerSummary:
    poses, times, radius = run.tracks[name].unicycle, run.times, None
    path = [poses[:, 0], poses[:, 1]]
    if run.tracks[name].qpos is not None or run.game == "play":
        path = [cycle_mean(way, times, run.settings.cycle) for way in path]
    if late.sum() > 2 and np.ptp(poses[late, 2]) > MIN_TURN:
        radius = fit_circle(poses[late, :2])[1]
    return PlayerSummary(
        path_m=float(np.hypot(*np.diff(path, axis=1)).sum()),
        radius_m=radius if radius is not None and isfinite(radius) else None,
    )
