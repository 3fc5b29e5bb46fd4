"""Head for the other (paper, Sec. II-A)."""

from dataclasses import dataclass
from math import atan2, cos, inf, pi, sin
from typing import ClassVar

import numpy as np

from ..arena import BODY_RADIUS, obstacle_set
from ..arena.shortest_path import first_point
from ..core.poses import wrap_angle
from ..core.ranges import Range, Ranges, check_settings
from ..planning import Direction
from ..theory import laws
from .approach import swift_heading
from .knowledge import Intent, Knowledge, Limits

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
        gain_ratio: Its steering gain over that of the gait, in [1]; above 0.
            No turn is larger than eq. (2) gives at the gait's gain, k pi:
            inf turns by the whole bearing in one step, up to that turn.
    """

    saturated: bool = False
    body_radius: float = BODY_RADIUS
    gain_ratio: float = 1.0

    ranges: ClassVar[Ranges] = {
        "body_radius": Range(0.0, 10.0, "m", "a body has some", above=True),
        "gain_ratio": Range(
            *(0.0, 1e3, "1"), "it turns to the evader", above=True, also=(inf,)
        ),
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
        return Intent(self._heading(bearing, knowledge.limits)), side

    def _heading(self, bearing: float, limits: Limits) -> float:
        """Desired heading of eq. (2) at the own gain, in [rad].

        A step turns by a share of it, which is that of the gait.
        """
        share = limits.gain * limits.stride / limits.speed
        ratio = min(self.gain_ratio, max(1.0, 1.0 / share))
        return min(max(ratio * laws.pursuit_heading(bearing), -pi), pi)

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
