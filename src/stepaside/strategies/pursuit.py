"""Pursuit: head for the evader (paper, Sec. II-A)."""

from dataclasses import dataclass
from math import atan2, cos, inf, pi, sin
from typing import Any

import numpy as np

from ..arena import BODY_RADIUS
from ..arena.shortest_path import first_waypoint
from ..core.poses import wrap_angle
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..planning import Direction
from ..theory import laws
from .approach import correcting_heading
from .knowledge import Intent, Knowledge, Limits

FREE_STRIDES = 3.0  # straight ahead that allow turning by (2)
DETOUR = 1e-3  # angle between target and evader that is a detour, [rad]


@dataclass(frozen=True, slots=True)
class Pursuit:
    """The paper's pursuer: head for the evader.

    With known obstacles it heads for the first vertex of the shortest path.
    """

    saturated: bool = setting(False, "Turn by eq. (6) instead of eq. (8)")
    body_radius: float = setting(
        BODY_RADIUS,
        "Clearance of the path from obstacles",
        Range(0.0, 10.0, "m", "a body has a radius", above=True),
    )
    gain_ratio: float = setting(
        1.0,
        "Steering gain over that of the gait {unit}. Turns are limited to "
        "what eq. (2) gives at the gait's gain, k pi: inf turns by the whole "
        "bearing in one step, up to that limit",
        Range(
            0.0, 1e3, "1", "it turns to the evader", above=True, also=(inf,)
        ),
    )

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)

    @property
    def direction(self) -> Direction:
        """Forward, eq. (1)."""
        return Direction.FORWARD

    def begin(self) -> int | None:
        """Return the side of the detour: none yet."""
        return None

    def decide(
        self, knowledge: Knowledge, memory: int | None
    ) -> tuple[Intent, int | None]:
        """Head for the evader by eq. (2), or along the path to it."""
        bearing, side = knowledge.bearing, None
        if knowledge.obstacles_in_map:
            bearing = self._path_bearing(knowledge, memory or 0)
            aside = wrap_angle(bearing - knowledge.bearing)
            if abs(aside) > DETOUR:
                side = 1 if aside > 0.0 else -1
            if side is not None or self._is_blocked(knowledge):
                # By (2) it would turn too slowly and walk into the obstacle.
                return Intent(
                    correcting_heading(bearing, knowledge.limits)
                ), side
        return Intent(self._heading(bearing, knowledge.limits)), side

    def _heading(self, bearing: float, limits: Limits) -> float:
        """Return the desired heading of eq. (2) at the own gain, in [rad].

        A step turns by a fraction of it, which depends on the gait.
        """
        share = limits.gain * limits.stride / limits.speed
        ratio = min(self.gain_ratio, max(1.0, 1.0 / share))
        return min(max(ratio * laws.pursuit_heading(bearing), -pi), pi)

    def _is_blocked(self, knowledge: Knowledge) -> bool:
        """Return whether the next straight steps violate the clearance."""
        x, y, theta = knowledge.pose_in_map
        ahead = FREE_STRIDES * knowledge.limits.stride
        path = [(x, y), (x + ahead * cos(theta), y + ahead * sin(theta))]
        now, after = knowledge.obstacles_in_map.clearances(np.array(path))
        nearer = after < np.minimum(self.body_radius, now - 1e-9)
        return bool(nearer.any())

    def _path_bearing(self, knowledge: Knowledge, side: int) -> float:
        """Return the bearing of the first vertex of the path, in [rad]."""
        x, y, theta = knowledge.pose_in_map
        sight = theta + knowledge.bearing
        evader = (
            x + knowledge.distance * cos(sight),
            y + knowledge.distance * sin(sight),
        )
        u, v = first_waypoint(
            knowledge.obstacles_in_map, (x, y), evader, self.body_radius, side
        )
        return wrap_angle(atan2(v - y, u - x) - theta)


class PursuitVariant:
    """Base of strategies that drive and turn as a pursuit of their own.

    Attributes:
        pursuit: Pursuit of the target that the strategy chooses.
    """

    __slots__ = ()

    pursuit: Pursuit

    @property
    def direction(self) -> Direction:
        """Forward, eq. (1)."""
        return self.pursuit.direction

    @property
    def saturated(self) -> bool:
        """Whether it turns by (6) instead of (8)."""
        return self.pursuit.saturated

    def begin(self) -> Any:
        """Return the memory of the pursuit."""
        return self.pursuit.begin()
