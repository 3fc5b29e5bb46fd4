r"""Homicidal chauffeur: a car chases a point that moves in any direction.

A person who walks at speed :math:`V` and turns no tighter than a radius
:math:`R` chases a robot that moves in any direction (Isaacs, Differential
Games, 1965). At each decision the robot commits to a velocity for a period;
the person answers with the turning rate that is worst for it. The best paths
are straight lines against full turns, so that a period may be long.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import acos, asin, sin, sqrt, tau

import numpy as np

from ...core.errors import PlanError, check_positive, check_within
from ...core.poses import Array
from .outcomes import PoseGrid
from .table import ValueTable, solve_game, sub_poses, turning

DIRECTIONS = 48  # of the evader's velocity
TURNS = 129  # of the pursuer; at first every 16th is tried
COARSE = 16
PERIOD = 0.31  # of a decision, over the speed ratio: 0.2 R/V at 0.643
AHEAD, BEHIND, ASIDE = 1.7, 0.8, 1.4  # edges, over the speed ratio
POINTS = 39  # of half a barrier


@dataclass(frozen=True, slots=True)
class ChauffeurGame:
    """Speeds of both players and the agility of the pursuer."""

    pursuer_speed: float  # speed of the pursuer, in [m/s]
    evader_speed: float  # of the evader, in any direction, in [m/s]
    turning_radius: float  # tightest radius of the pursuer's turns, in [m]

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.pursuer_speed, "pursuer_speed", "m/s")
        check_positive(self.evader_speed, "evader_speed", "m/s")
        check_positive(self.turning_radius, "turning_radius", "m")
        if not self.evader_speed < self.pursuer_speed:
            raise PlanError(
                "evader_speed must be < pursuer_speed, "
                f"{self.pursuer_speed:g} [m/s]: an evader that is as fast "
                f"can always run away, got {self.evader_speed:g}"
            )

    @property
    def turn(self) -> float:
        """Largest turning rate of the pursuer, in [rad/s]."""
        return self.pursuer_speed / self.turning_radius

    @property
    def ratio(self) -> float:
        """Speed of the evader over that of the pursuer."""
        return self.evader_speed / self.pursuer_speed

    @property
    def period(self) -> float:
        """Time between decisions, a small part of a turn, in [s]."""
        return PERIOD * self.ratio / self.turn

    @property
    def guaranteed_distance(self) -> float:
        """Closed form of the guaranteed distance, in [m].

        A capture distance below it is avoidable from every start outside
        the barrier; one above it from none.
        """
        return self.turning_radius * guaranteed_distance(self.ratio)

    def barrier(self, capture: float) -> Array | None:
        """Return poses on the left half of the barrier, without its ends.

        There is a closed form up to 0.897 of the speed of the car, and for
        capture distances, in [m], below the guaranteed one; None beyond. They
        lead from the circle of capture to where both halves meet. Shape
        (POINTS, 3).
        """
        ratio, radius = self.ratio, self.turning_radius
        keepable = 0.0 < capture < self.guaranteed_distance
        if ratio * asin(ratio) > 1.0 or not keepable:
            return None
        s, own = acos(ratio), capture / radius

        def aside(t: Array) -> Array:
            side: Array = (own - ratio * t) * np.sin(s + t) + 1.0 - np.cos(t)
            return side

        fine = np.linspace(0.0, asin(ratio), 20_000)
        end = fine[np.argmax(aside(fine) <= 0.0)]
        t = np.linspace(0.0, end, POINTS + 2)[1:-1]
        ahead = (own - ratio * t) * np.cos(s + t) + np.sin(t)
        return radius * np.column_stack([ahead, aside(t), 0.0 * t])

    @property
    def twists(self) -> Array:
        """Velocities of the evader along the line of sight. Shape (n, 3)."""
        angles = tau / DIRECTIONS * np.arange(DIRECTIONS)
        edge = [np.cos(angles), np.sin(angles), 0.0 * angles]
        still = np.zeros((1, 3))
        return np.concatenate([self.evader_speed * np.transpose(edge), still])

    @property
    def turns(self) -> Array:
        """Velocities of the pursuer. Shape (m, 3)."""
        return turning(self.pursuer_speed, self.turn, TURNS)


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
        cells: Number of cells over the speed of the evader times the radius
            over the pursuer's speed. The guaranteed distance is off by 0.3 %
            at most at 60 cells and speed ratios from 0.36, by 1.6 % at 30.
        farthest: Largest distance ahead in the table, in [m].
        progress: Called with fractions of the work done since the last call.
    """
    check_within(cells, 8, 400, "cells", "1")
    held, limit = game.period, game.guaranteed_distance
    unit = game.ratio * game.turning_radius
    rest = limit + held * game.pursuer_speed
    grid = PoseGrid.covering(
        unit / cells,
        max(AHEAD * unit + rest, farthest or 0.0),
        BEHIND * unit + rest,
        ASIDE * unit + rest,
    )
    moves = game.evader_speed + game.pursuer_speed
    table = solve_game(
        sub_poses(game.twists, held),
        sub_poses(game.turns, held),
        grid._replace(cubic=True, coarse=COARSE),
        until=2e-5 * limit,
        most=2.0 * limit,
        outside=lambda v: float(v[-1, 0, 0]),
        reach=held * (moves + game.turn * grid.farthest),
        progress=progress,
    )
    kept = np.minimum(table.values, table.grid.outside)
    return replace(table, values=kept, after=kept)


def guaranteed_distance(ratio: float) -> float:
    r"""Return the largest distance that a point can keep, in turning radii.

    Against the full turn of the car the evader runs straight along the
    normal of the capture circle. Both barriers close ahead of the car where
    they are tangential to its axis, which for a speed ratio :math:`\gamma`
    gives

    .. math::
        \sqrt{1 - \gamma^2} + \gamma \arcsin \gamma - 1
        \quad (\gamma \arcsin \gamma \le 1), \qquad
        \sqrt{1 + \gamma^2 - 2 \gamma \sin(1 / \gamma)}

    above, where the evader can circle with the car.
    """
    check_within(ratio, 1e-6, 1.0, "ratio", "1")
    if ratio * asin(ratio) <= 1.0:
        return sqrt(1.0 - ratio**2) + ratio * asin(ratio) - 1.0
    return sqrt(1.0 + ratio**2 - 2.0 * ratio * sin(1.0 / ratio))
