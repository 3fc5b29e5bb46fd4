"""Where a player saw the other, in its own odometry."""

import numpy as np

from ..core.poses import Array
from .play_rows import PlayedRows
from .trajectory import Trajectory

SAME = 1e-6  # between two times of one sighting, in [s]


def sightings_in(rows: PlayedRows) -> Array:
    """Each sighting once, and each loss.

    Returns:
        When it became known and when it was taken, in [s], bearing [rad]
        and distance [m]; NaN where nobody was seen any more. Shape (k, 4).
    """
    seen = rows.columns["sighting"]
    taken = seen[:, 0] + rows.offset
    lost = np.isnan(taken)
    before = np.concatenate([[np.nan], taken[:-1]])
    with np.errstate(invalid="ignore"):
        new = ~lost & ~(np.abs(taken - before) < SAME)
    gone = lost & ~np.isnan(before)
    chosen = np.flatnonzero(new | gone)
    return np.column_stack(
        [rows.times[chosen], taken[chosen], seen[chosen, 1:]]
    )


def sight_table(found: Array) -> Array:
    """Sightings as a run keeps them; the truth is not known. Shape (k, 6).

    Args:
        found: As of :func:`sightings_in`.
    """
    unknown = np.full((len(found), 2), np.nan)
    lost = np.isnan(found[:, 1]).astype(float)
    return np.column_stack([found[:, 0], found[:, 2:], unknown, lost])


def track_of_other(
    found: Array, times: Array, own: Array
) -> Trajectory | None:
    """Where the other was seen last; None if it never was.

    Args:
        found: As of :func:`sightings_in`.
        times: Of the samples, in [s]. Shape (n,).
        own: Place and heading of who saw it, then. Shape (n, 3).
    """
    seen = found[~np.isnan(found[:, 1])]
    if not len(seen):
        return None
    known, taken, bearing, distance = seen.T
    x, y, heading = (np.interp(taken, times, column) for column in own.T)
    toward = heading + bearing
    rows = np.column_stack(
        [
            x + distance * np.cos(toward),
            y + distance * np.sin(toward),
            np.unwrap(toward + np.pi),
        ]
    )
    # Before it was seen it stands where it will be seen first.
    newest = np.searchsorted(known, times + 1e-9, side="right") - 1
    torso = rows[np.maximum(newest, 0)]
    com = torso.copy()
    com[:, 2] = 0.0
    return Trajectory(com=com, torso=torso)
