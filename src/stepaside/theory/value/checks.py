"""Verification of tables by closed forms and by simulated games."""

from collections.abc import Callable

import numpy as np

from ...core.poses import Array, arc, rotate
from .table import ValueTable

Evader = Callable[[Array], Array]
"""Velocities ahead, left [m/s] and turning [rad/s], by poses. Shape (n, 3)."""
Pursuer = Callable[[Array, Array], Array]
"""The same of the pursuer, by poses and velocities of the evader."""


def play(
    starts: Array,
    evader: Evader,
    pursuer: Pursuer,
    *,
    period: float,
    duration: float,
    parts: int = 8,
    faces: bool = False,
    reacts: bool = False,
) -> Array:
    """Simulate games along exact arcs.

    Args:
        starts: Poses of the evader in the frame of the pursuer, in [m] and
            [rad]. Shape (n, 3).
        evader: Velocities to which the evader commits for a period.
        pursuer: Velocities of the pursuer in answer.
        period: Time between two decisions of the evader, in [s].
        duration: Duration of the games, in [s].
        parts: Parts of a period in which the distance is measured.
        faces: Whether the evader is turned away from the pursuer when it
            decides.
        reacts: Whether the pursuer decides at each part of a period.

    Returns:
        Closest approach of each game, in [m]. Shape (n,).
    """
    poses = np.array(starts, dtype=np.float64)
    least: Array = np.hypot(poses[:, 0], poses[:, 1])
    step = period / parts
    for n in range(round(duration / step)):
        if n % parts == 0:
            if faces:
                poses[:, 2] = np.arctan2(poses[:, 1], poses[:, 0])
            chosen = evader(poses)
            answer = pursuer(poses, chosen)
        elif reacts:
            answer = pursuer(poses, chosen)
        own, other = arc(*step * chosen.T), arc(*step * answer.T)
        x, y, theta = poses.T
        moved, turned = rotate(own[:, 0], own[:, 1], theta), other[:, 2]
        x, y = x + moved[0] - other[:, 0], y + moved[1] - other[:, 1]
        x, y = rotate(x, y, -turned)
        poses = np.column_stack([x, y, theta + own[:, 2] - turned])
        least = np.minimum(least, np.hypot(x, y))
    return least


def barrier_offsets(table: ValueTable, poses: Array, capture: float) -> Array:
    """Return how far the barrier of a table is from states, in [m].

    Offsets are those in the pursuer's plane, to first order; positive inside
    what can be captured by the table.

    Args:
        table: Table of the game.
        poses: Poses on the barrier of a capture distance. Shape (n, 3).
        capture: The distance, in [m].
    """
    step = table.grid.spacing * np.eye(3)[:2]
    rises = [table.value(poses + d) - table.value(poses - d) for d in step]
    slope = np.hypot(*rises) / (2.0 * table.grid.spacing)
    off: Array = (capture - table.value(poses)) / np.maximum(slope, 1e-3)
    return off
