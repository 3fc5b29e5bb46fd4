"""Evasion of several pursuers: look-ahead over turning sequences."""

from dataclasses import dataclass
from functools import lru_cache
from math import atan2, inf, pi
from typing import NamedTuple

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array, wrap_angles
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..theory import laws
from .knowledge import STAND, Intent, Knowledge
from .strategy import BackwardStrategy

PIECES = (4, 8, 16)  # steps with a constant turn
TURNS = 7  # values of the turn of each piece
FINAL = 0.2  # weight of the distance at the end beside the closest one
SMALL = 1e-6  # weight of a turn, against ties


class SeveralPursuers(NamedTuple):
    """Poses of pursuers in the frame of a knowledge.

    Attributes:
        x: Positions ahead, in [m]. Shape (n,).
        y: Positions to the left, in [m]. Shape (n,).
        theta: Headings, in [rad]. Shape (n,).
    """

    x: Array
    y: Array
    theta: Array


@dataclass(frozen=True, slots=True)
class TeamEvasion(BackwardStrategy):
    """Evader that reasons about all pursuers at once.

    It walks backward, and begins the turning sequence after which the
    smallest predicted distance to any pursuer is largest. Each pursuer is
    predicted by eqs. (1)-(2) with the own gait, so that a sequence away from
    one pursuer into another one scores low. This is no guarantee: the
    pursuers may move otherwise.
    """

    safety_radius: float = setting(
        0.8,
        "Distance of the nearest pursuer at which evasion begins",
        Range(1e-3, 1e9, "m", "below a millimetre there is contact"),
    )
    release_distance: float = setting(
        inf,
        "Distance of the nearest pursuer at which evasion ends",
        Range(1e-3, 1e9, "m", "and above safety_radius", also=(inf,)),
    )

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)
        if not self.release_distance > self.safety_radius:
            raise ConfigurationError(
                "release_distance must exceed safety_radius, "
                f"{self.safety_radius:g} [m], got {self.release_distance}"
            )

    def begin(self) -> bool:
        """Return that it does not evade yet."""
        return False

    def decide(
        self, knowledge: Knowledge, memory: bool
    ) -> tuple[Intent, bool]:
        """Stand until the trigger, then begin the best sequence."""
        nearest = min(
            (other.distance for other in knowledge.opponents),
            default=knowledge.distance,
        )
        evading = laws.is_evading(
            memory, nearest, self.safety_radius, self.release_distance
        )
        if not evading:
            return STAND, False
        limits = knowledge.limits
        share = limits.share
        turns = candidate_turns(pi * share)
        closest, final = closest_approaches(
            pursuers_of(knowledge), turns, limits.stride, share
        )
        least, last = closest.min(axis=1), final.min(axis=1)
        score = least + FINAL * last - SMALL * np.abs(turns[:, 0])
        best = turns[int(score.argmax()), 0]
        return Intent(float(best) / share), True


def pursuers_of(knowledge: Knowledge) -> SeveralPursuers:
    """Return the poses of all opponents; of the opponent without a team.

    One of unknown velocity is taken to face the evader.
    """
    rows = []
    for other in knowledge.opponents or (knowledge,):
        x = other.distance * np.cos(other.bearing)
        y = other.distance * np.sin(other.bearing)
        velocity = other.velocity
        heading = atan2(-y, -x)
        if velocity is not None and np.hypot(*velocity) > 0.01:
            heading = atan2(velocity[1], velocity[0])
        rows.append((x, y, heading))
    return SeveralPursuers(*np.array(rows).T)


@lru_cache(maxsize=8)
def candidate_turns(largest: float) -> Array:
    """Return turning sequences, one row each, in [rad] per step.

    Args:
        largest: Greatest turn of a step, in [rad].

    Returns:
        Every combination of constant turns in three pieces. Shape
        (candidates, steps).
    """
    even = np.linspace(-largest, largest, TURNS)
    grid = np.meshgrid(*[even] * len(PIECES), indexing="ij")
    pieces = np.stack(grid, axis=-1).reshape(-1, len(PIECES))
    turns: Array = np.repeat(pieces, PIECES, axis=1)
    turns.setflags(write=False)
    return turns


def closest_approaches(
    pursuers: SeveralPursuers, turns: Array, stride: float, share: float
) -> tuple[Array, Array]:
    """Predict the distances to pursuers under turning sequences.

    The evader walks backward from the origin of the frame, the pursuers head
    for it by (1)-(2); all have one stride and gain.

    Args:
        pursuers: Their poses in the frame.
        turns: Turns of the evader, in [rad] per step. Shape (candidates,
            steps).
        stride: Length of a step, in [m].
        share: Turn of a step per desired heading, kappa.

    Returns:
        Smallest and last distance to each pursuer, in [m]. Shapes
        (candidates, pursuers).
    """
    count = len(turns)
    x, y, theta = (np.zeros(count) for _ in range(3))
    px, py, heading = (np.tile(row, (count, 1)) for row in pursuers)
    away = np.hypot(px, py)
    closest = away.copy()
    for turn in turns.T:
        middle = theta + 0.5 * turn
        x, y = x - stride * np.cos(middle), y - stride * np.sin(middle)
        theta = theta + turn
        aim = np.arctan2(y[:, None] - py, x[:, None] - px)
        error = share * wrap_angles(aim - heading)
        middle = heading + 0.5 * error
        px = px + stride * np.cos(middle)
        py = py + stride * np.sin(middle)
        heading = heading + error
        away = np.hypot(x[:, None] - px, y[:, None] - py)
        np.minimum(closest, away, out=closest)
    return closest, away
