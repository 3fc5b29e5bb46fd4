r"""Homicidal chauffeur: a car chases a point that moves in any direction.

A person who walks at speed :math:`V` and turns no tighter than a radius
:math:`R` chases a robot that moves in any direction (Isaacs, Differential
Games, 1965). At each decision the robot commits to a velocity for a period;
the person answers with the turning rate that is worst for it. The best paths
are straight lines against full turns, so that a period may be long.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import tau

import numpy as np

from ...core.errors import PlanError, check_positive, check_within
from ...core.poses import Array
from .closed_forms import chauffeur_barrier, guaranteed_distance
from .pose_grid import PoseGrid, sub_poses
from .solver import solve_game
from .table import ValueTable

ROUND = 1e-9  # relative difference of speeds that count as equal
DIRECTIONS = 48  # of the evader's velocity
TURNS = 129  # of the pursuer; at first every 16th is tried
COARSE = 16
PERIOD = 0.31  # of a decision, over the speed ratio: 0.2 R/V at 0.643
AHEAD, BEHIND, ASIDE = 1.7, 0.8, 1.4  # edges, over the speed ratio


@dataclass(frozen=True, slots=True)
class SpeedEllipse:
    """Velocities of a robot that faces its pursuer.

    The set is bounded by two half ellipses through the three speeds; that
    of a disc has equal ones. Any smaller velocity is possible, too.
    """

    forward: float  # largest speed towards the pursuer, in [m/s]
    backward: float  # largest speed away from it, in [m/s]
    sideways: float  # largest speed across the line of sight, in [m/s]

    def __post_init__(self) -> None:
        """Check the speeds."""
        check_positive(self.forward, "forward", "m/s")
        check_positive(self.backward, "backward", "m/s")
        check_positive(self.sideways, "sideways", "m/s")

    @classmethod
    def disc(cls, speed: float) -> "SpeedEllipse":
        """Return the set with one speed in every direction, in [m/s]."""
        return cls(speed, speed, speed)

    @property
    def largest(self) -> float:
        """Largest speed in any direction, in [m/s]."""
        return max(self.forward, self.backward, self.sideways)

    @property
    def smallest(self) -> float:
        """Radius of the largest disc within the set, in [m/s]."""
        return min(self.forward, self.backward, self.sideways)

    def boundary(self, count: int) -> Array:
        """Return velocities on the boundary, and zero. Shape (count + 1, 2).

        They point away from the pursuer and to the left of the line of sight
        from the pursuer, in [m/s].
        """
        angles = tau * np.arange(count) / count
        along, across = np.cos(angles), np.sin(angles)
        speed = np.where(along < 0.0, self.forward, self.backward)
        edge = np.column_stack([speed * along, self.sideways * across])
        return np.concatenate([edge, np.zeros((1, 2))])


@dataclass(frozen=True, slots=True)
class ChauffeurGame:
    """Speeds of both players and the agility of the pursuer."""

    pursuer_speed: float  # speed of the pursuer, in [m/s]
    turning_radius: float  # tightest radius of its turns, in [m]
    velocities: SpeedEllipse  # velocities of the evader

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.pursuer_speed, "pursuer_speed", "m/s")
        check_positive(self.turning_radius, "turning_radius", "m")
        if not self.velocities.largest < self.pursuer_speed:
            raise PlanError(
                "evader_speed must be < pursuer_speed, "
                f"{self.pursuer_speed:g} [m/s]: an evader that is as fast "
                f"can always run away, got {self.velocities.largest:g}"
            )

    @property
    def turn(self) -> float:
        """Largest turning rate of the pursuer, in [rad/s]."""
        return self.pursuer_speed / self.turning_radius

    @property
    def ratio(self) -> float:
        """Largest speed of the evader over that of the pursuer."""
        return self.velocities.largest / self.pursuer_speed

    @property
    def period(self) -> float:
        """Time between decisions, a small part of a turn, in [s]."""
        return PERIOD * self.ratio / self.turn

    @property
    def guaranteed_distance(self) -> float | None:
        """Closed form of the guaranteed distance, in [m]; None if not round.

        A capture distance below it is avoidable from every start outside
        the barrier; one above it from none.
        """
        largest, smallest = self.velocities.largest, self.velocities.smallest
        if largest - smallest > ROUND * largest:
            return None
        return self.turning_radius * guaranteed_distance(self.ratio)

    @property
    def twists(self) -> Array:
        """Velocities of the evader along the line of sight. Shape (n, 3)."""
        return np.insert(self.velocities.boundary(DIRECTIONS), 2, 0.0, axis=1)

    @property
    def turns(self) -> Array:
        """Velocities of the pursuer. Shape (m, 3)."""
        rates = np.linspace(-self.turn, self.turn, TURNS)
        return np.column_stack(
            [np.full(TURNS, self.pursuer_speed), 0.0 * rates, rates]
        )


def solve_chauffeur(
    game: ChauffeurGame,
    cells: int = 40,
    *,
    farthest: float | None = None,
    progress: Callable[[float], object] | None = None,
) -> ValueTable:
    """Compute the distance that is guaranteed from every relative state.

    No distance above that of a pursuer that comes back from afar, which is
    the one straight ahead at the far edge, can be kept; meanwhile values are
    cut off at twice the closed form of it.

    Args:
        game: Speeds and turning radius.
        cells: Number of cells over the largest speed of the evader times the
            radius over the pursuer's speed. The guaranteed distance is off
            by 0.3 % at most at 60 cells and speed ratios from 0.36, by 1.6 %
            at 30.
        farthest: Largest distance ahead in the table, in [m].
        progress: Called with fractions of the work done since the last call.
    """
    check_within(cells, 8, 400, "cells", "1")
    held = game.period
    unit = game.ratio * game.turning_radius
    limit = game.turning_radius * guaranteed_distance(game.ratio)
    rest = limit + held * game.pursuer_speed
    grid = PoseGrid.covering(
        unit / cells,
        max(AHEAD * unit + rest, farthest or 0.0),
        BEHIND * unit + rest,
        ASIDE * unit + rest,
    )
    moves = game.velocities.largest + game.pursuer_speed
    table = solve_game(
        sub_poses(game.twists, held),
        sub_poses(game.turns, held),
        grid,
        interpolate="cubic",
        until=2e-5 * limit,
        most=2.0 * limit,
        coarse=COARSE,
        outside=lambda v: float(v[-1, 0, 0]),
        reach=held * (moves + game.turn * grid.farthest),
        progress=progress,
    )
    kept = np.minimum(table.values, table.rules.outside)
    return replace(table, values=kept, after=kept)


def barrier_of(game: ChauffeurGame, capture: float) -> Array:
    """Return poses on the left half of the barrier, without its ends.

    The evader has one speed in every direction; the capture distance is
    below the guaranteed one, in [m]. Shape (n, 3).
    """
    if game.guaranteed_distance is None:
        raise PlanError(
            "the barrier is known for one speed in every direction"
        )
    radius = game.turning_radius
    line = chauffeur_barrier(game.ratio, capture / radius, 41)[1:-1]
    return np.insert(radius * line, 2, 0.0, axis=1)
