"""Evasion of people who may walk on, or turn towards the robot."""

from dataclasses import dataclass, replace
from math import hypot, inf

from ..core.errors import ConfigurationError, check_within
from ..core.poses import Array, Pose
from .dash_evasion import CHASER_RADIUS, DashEvasion
from .dash_rollouts import Opponent

MOST = 100.0  # of doubt and alertness


@dataclass(frozen=True, slots=True)
class WaryEvasion(DashEvasion):
    """Evader that dashes clear of a course, and of turns from it.

    A dash is worth the closest approach of an opponent who keeps its course,
    and a share of that of one who steers at the robot. So the robot leaves
    the path of a person who walks straight as :class:`DashEvasion` does, to
    the side on which it also has room if the person turns. It begins to
    compare dashes when the person could be near soon, even one who would
    pass.

    Attributes:
        turning_radius: Turning radius of an opponent who steers, in [m].
        doubt: Weight of an opponent who steers, relative to one who walks
            straight.
        alertness: Time in which the opponent could be within the clearance,
            from which on dashes are compared, in [s].
    """

    turning_radius: float = CHASER_RADIUS
    clearance: float = 1.0
    contact_time: float = 3.5
    doubt: float = 0.5
    alertness: float = 1.5

    def __post_init__(self) -> None:
        """Validate the settings."""
        DashEvasion.__post_init__(self)
        error = ConfigurationError
        check_within(self.doubt, 0.0, MOST, "doubt", "1", error)
        check_within(self.alertness, 0.0, MOST, "alertness", "s", error)

    def _is_near(self, pose: Pose, opponent: Opponent) -> bool:
        """Return whether a standing robot has to compare dashes."""
        straight = replace(self, turning_radius=inf)
        if DashEvasion._is_near(straight, pose, opponent):
            return True
        distance = hypot(opponent.x - pose.x, opponent.y - pose.y)
        return distance < self.clearance + self.alertness * opponent.speed

    def _values(self, paths: Array, opponent: Opponent) -> Array:
        """Return the value of each dash, in [m]. Shape (n,)."""
        steering = DashEvasion._values(self, paths, opponent)
        straight = replace(self, turning_radius=inf)
        walking = DashEvasion._values(
            straight, paths, replace(opponent, turning_radius=inf)
        )
        found: Array = (walking + self.doubt * steering) / (1.0 + self.doubt)
        return found
