"""Optimal pursuit in the game of two identical cars."""

from dataclasses import dataclass
from math import atan2, pi

from ..core.errors import ConfigurationError, check_within
from ..core.poses import wrap_angle
from .bound_cache import cars_bound
from .knowledge import Knowledge
from .opponent_track import OpponentSighting, PathPursuit


@dataclass(frozen=True, slots=True)
class OptimalPursuit(PathPursuit):
    """Pursuer with the smallest closest approach to an optimal evader.

    The evader may turn as fast as the pursuer; the floor is open.

    Attributes:
        cells: Number of cells along each axis of the table.
    """

    cells: int = 64

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_within(self.cells, 16, 200, "cells", "1", ConfigurationError)

    def heading(
        self, knowledge: Knowledge, sighting: OpponentSighting, course: float
    ) -> float:
        """Return the heading that yields the turning rate of the table."""
        limits = knowledge.limits
        unit = limits.speed / (pi * limits.gain)  # tightest radius, in [m]
        sight = atan2(sighting.y - sighting.own_y, sighting.x - sighting.own_x)
        turn = cars_bound(self.cells).pursuer_turn(
            knowledge.distance / unit,
            knowledge.bearing,
            # The evader is a car that faces against its direction of motion.
            wrap_angle(sight - course),
        )
        return pi * float(turn)
