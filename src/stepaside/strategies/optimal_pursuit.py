"""The best pursuer of the game of two identical cars."""

from dataclasses import dataclass
from math import atan2, pi

from ..core.errors import ConfigurationError, check_within
from ..core.poses import wrap_angle
from .bound_cache import cars_bound
from .knowledge import Knowledge
from .opponent_track import OpponentSighting, PathPursuit


@dataclass(frozen=True, slots=True)
class OptimalPursuit(PathPursuit):
    """Turn as the table says that comes nearest to the best evader.

    The evader may turn as fast as the pursuer, and the floor is open.

    Attributes:
        cells: Of the table.
    """

    cells: int = 64

    def __post_init__(self) -> None:
        """Refuse tables that nobody solves."""
        check_within(self.cells, 16, 200, "cells", "1", ConfigurationError)

    def heading(
        self, knowledge: Knowledge, seen: OpponentSighting, way: float
    ) -> float:
        """What turns as fast as the table says, as a share of the fastest."""
        limits = knowledge.limits
        unit = limits.speed / (pi * limits.gain)  # tightest radius, in [m]
        sight = atan2(seen.y - seen.own_y, seen.x - seen.own_x)
        turn = cars_bound(self.cells).pursuer_turn(
            knowledge.distance / unit,
            knowledge.bearing,
            # A car: it looks against the way that the evader walks.
            wrap_angle(sight - way),
        )
        return pi * float(turn)
