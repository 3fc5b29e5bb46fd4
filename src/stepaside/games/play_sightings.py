"""Sightings of a player at a robot, in its own odometry."""

import numpy as np

from ..core.poses import Array
from .play_rows import PlayedRows
from .trajectory import Trajectory

SAME = 1e-6  # tolerance within which times are of one sighting, in [s]


def sightings_in(rows: PlayedRows) -> Array:
    """Extract each new sighting and each loss of the opponent.

    Returns:
        Time of arrival [s], time of measurement [s], bearing [rad] and
        distance [m]; NaN after arrival where the opponent was lost. Shape
        (k, 4).
    """
    sightings = rows.columns["sighting"]
    taken = sightings[:, 0] + rows.offset
    lost = np.isnan(taken)
    before = np.concatenate([[np.nan], taken[:-1]])
    with np.errstate(invalid="ignore"):
        new = ~lost & ~(np.abs(taken - before) < SAME)
    gone = lost & ~np.isnan(before)
    chosen = np.flatnonzero(new | gone)
    return np.column_stack(
        [rows.times[chosen], taken[chosen], sightings[chosen, 1:]]
    )


def sight_table(found: Array) -> Array:
    """Convert sightings to the array of a run, with the truth unknown.

    Args:
        found: Sightings of :func:`sightings_in`. Shape (k, 4).

    Returns:
        Array ``sight`` of :class:`Trajectory`. Shape (k, 6).
    """
    unknown = np.full((len(found), 2), np.nan)
    lost = np.isnan(found[:, 1]).astype(float)
    return np.column_stack([found[:, 0], found[:, 2:], unknown, lost])


def track_of_other(
    found: Array, times: Array, own: Array
) -> Trajectory | None:
    """Return the trajectory of the opponent's last sightings.

    Args:
        found: Sightings of :func:`sightings_in`. Shape (k, 4).
        times: Times of the samples, in [s]. Shape (n,).
        own: Poses (x, y, heading) of the player in odometry, in [m] and
            [rad]. Shape (n, 3).

    Returns:
        Trajectory in odometry; None without a sighting.
    """
    sightings = found[~np.isnan(found[:, 1])]
    if not len(sightings):
        return None
    arrived, taken, bearing, distance = sightings.T
    x, y, heading = (np.interp(taken, times, column) for column in own.T)
    toward = heading + bearing
    rows = np.column_stack(
        [
            x + distance * np.cos(toward),
            y + distance * np.sin(toward),
            np.unwrap(toward + np.pi),
        ]
    )
    # Before its first sighting the opponent is put at that sighting.
    newest = np.searchsorted(arrived, times + 1e-9, side="right") - 1
    torso = rows[np.maximum(newest, 0)]
    com = torso.copy()
    com[:, 2] = 0.0
    return Trajectory(com=com, torso=torso)
