"""Games simulated by the decisions of a table of values."""

from collections.abc import Callable

import numpy as np

from stepaside.core.poses import Array, arc, rotate
from stepaside.theory.value import ValueTable

Player = Callable[[Array], Array]
PARTS = 8  # of a period, in which the distance is measured


def play(
    starts: Array,
    evader: Player,
    pursuer: Player,
    *,
    period: float,
    duration: float,
    faces: bool = False,
    reacts: bool = False,
) -> Array:
    """Simulate games along exact arcs; return closest approaches.

    Players give velocities by the poses of the evader in the pursuer's
    frame. The evader commits for a period, in which a pursuer that reacts
    decides again; one that faces is turned away when it decides.
    """
    poses = starts.copy()
    least: Array = np.hypot(poses[:, 0], poses[:, 1])
    for n in range(round(duration / period * PARTS)):
        if n % PARTS == 0:
            if faces:
                poses[:, 2] = np.arctan2(poses[:, 1], poses[:, 0])
            chosen = evader(poses)
        if reacts or n % PARTS == 0:
            answer = pursuer(poses)
        own, other = (arc(*(period / PARTS * v.T)) for v in (chosen, answer))
        x, y, theta = poses.T
        ends = rotate(own[:, 0], own[:, 1], theta) - other[:, :2].T
        x, y = rotate(x + ends[0], y + ends[1], -other[:, 2])
        poses = np.column_stack([x, y, theta + own[:, 2] - other[:, 2]])
        least = np.minimum(least, np.hypot(x, y))
    return least


def by_table(table: ValueTable, twists: Array, player: int) -> Player:
    """Return the evader, 0, or the pursuer, 1, of a table."""
    return lambda poses: twists[table.decisions(poses)[:, player]]


def towards(time: float) -> Player:
    """Return a car of unit speed and turn that steers at the evader."""

    def steer(poses: Array) -> Array:
        aim = np.arctan2(poses[:, 1], poses[:, 0])
        turn = np.clip(aim / time, -1.0, 1.0)
        return np.column_stack([np.ones_like(turn), 0.0 * turn, turn])

    return steer
