"""Head for the other (paper, Sec. II-A)."""

from dataclasses import dataclass
from math import atan2, cos, sin
from typing import ClassVar

import numpy as np

from .. import laws
from ..planning import Direction
from ..poses import wrap_angle
from ..ranges import Range, Ranges, check_settings
from ..rooms import BODY_RADIUS, obstacle_set
from ..rooms.paths import first_point
from .approach import swift_heading
from .knowledge import Intent, Knowledge

AHEAD = 3.0  # strides that are free where it heads by (2)
ASIDE = 1e-3  # of the other, from which on it goes around something, [rad]


@dataclass(frozen=True, slots=True)
class Pursuit:
    """Head for the other, always: the pursuer knows of the evader.

    Where it knows what stands around, it heads for the first point of the
    shortest way there that it sees.

    Attributes:
        saturated: Whether to turn by (6) instead of (8).
        body_radius: Distance that its way keeps from what stands around, in
            [m]; above 0 to 10.
    """

    saturated: bool = False
    body_radius: float = BODY_RADIUS

    ranges: ClassVar[Ranges] = {
        "body_radius": Range(0.0, 10.0, "m", "a body has some", above=True)
    }

    def __post_init__(self) -> None:
        """Refuse bodies that are none."""
        check_settings(self)

    @property
    def direction(self) -> Direction:
        """Forward, eq. (1)."""
        return Direction.FORWARD

    def begin(self) -> int | None:
        """Side on which it goes around something: none yet."""
        return None

    def decide(
        self, knowledge: Knowledge, memory: int | None
    ) -> tuple[Intent, int | None]:
        """Point at the other, eq. (2), or at where the way to it leads."""
        bearing, side = knowledge.bearing, None
        if knowledge.obstacles:
            bearing = self._around(knowledge, memory or 0)
            aside = wrap_angle(bearing - knowledge.bearing)
            if abs(aside) > ASIDE:
                side = 1 if aside > 0.0 else -1
            if side is not None or self._is_shut(knowledge):
                # By (2) it would walk on into what it is to go around.
                return Intent(swift_heading(bearing, knowledge.limits)), side
        return Intent(laws.pursuit_heading(bearing)), side

    def _is_shut(self, knowledge: Knowledge) -> bool:
        """Whether the next steps straight on come too near to something."""
        x, y, theta = knowledge.pose
        ahead = AHEAD * knowledge.limits.stride
        way = [(x, y), (x + ahead * cos(theta), y + ahead * sin(theta))]
        here, after = obstacle_set(knowledge.obstacles).clearances(
            np.array(way)
        )
        nearer = after < np.minimum(self.body_radius, here - 1e-9)
        return bool(nearer.any())

    def _around(self, knowledge: Knowledge, side: int) -> float:
        """Bearing of the first point of the shortest way, in [rad]."""
        x, y, theta = knowledge.pose
        sight = theta + knowledge.bearing
        other = (
            x + knowledge.distance * cos(sight),
            y + knowledge.distance * sin(sight),
        )
        u, v = first_point(
            knowledge.obstacles, (x, y), other, self.body_radius, side
        )
        return wrap_angle(atan2(v - y, u - x) - theta)
