"""How near somebody comes who walks straight on, and how soon."""

from math import atan2, cos, hypot, inf, pi, sin, sqrt
from typing import NamedTuple

from ..core.poses import wrap_angle
from .knowledge import Knowledge, Limits

STILL = 0.05  # speed below which nobody comes from anywhere, in [m/s]
SHARPEST = 0.5 * pi  # bearing by which a step turns at most, in [rad]
LOOKED = 24  # steps that are looked ahead when a side is chosen


class Approach(NamedTuple):
    """The other in the own frame.

    Attributes:
        x: Place ahead, in [m].
        y: Place to the left, in [m].
        u: Velocity on the floor ahead, in [m/s].
        v: Velocity on the floor to the left, in [m/s].
    """

    x: float
    y: float
    u: float
    v: float

    @classmethod
    def of(cls, knowledge: Knowledge) -> "Approach":
        """The other as it is known; at rest while nothing else is known.

        What was seen a while ago has moved on since.
        """
        u, v = knowledge.velocity or (0.0, 0.0)
        x = knowledge.distance * cos(knowledge.bearing)
        y = knowledge.distance * sin(knowledge.bearing)
        age = knowledge.age
        return cls(x + age * u, y + age * v, u, v)

    @property
    def distance(self) -> float:
        """To the other, in [m]."""
        return hypot(self.x, self.y)

    @property
    def speed(self) -> float:
        """Of the other, in [m/s]."""
        return hypot(self.u, self.v)

    @property
    def origin(self) -> float:
        """Direction that the other comes from, in [rad].

        Of somebody who hardly moves it is the line of sight.
        """
        if self.speed < STILL:
            return atan2(self.y, self.x)
        return atan2(-self.v, -self.u)

    @property
    def miss(self) -> float:
        """Least distance from now on if this robot stays, in [m]."""
        nearing = -(self.x * self.u + self.y * self.v)
        if nearing <= 0.0:
            return self.distance
        return abs(self.x * self.v - self.y * self.u) / self.speed

    def contact_time(self, clearance: float) -> float:
        """Time until the other is nearer than a clearance, in [s].

        Args:
            clearance: In [m].

        Returns:
            The time if this robot stays; 0 for somebody who is nearer and
            still coming, infinite for somebody who passes or leaves.
        """
        nearing = -(self.x * self.u + self.y * self.v)
        if nearing <= 0.0 or self.speed < STILL:
            return inf
        excess = self.x * self.x + self.y * self.y - clearance * clearance
        if excess <= 0.0:
            return 0.0
        square = self.u * self.u + self.v * self.v
        root = nearing * nearing - square * excess
        if root < 0.0:
            return inf
        return excess / (nearing + sqrt(root))


def swift_heading(error: float, limits: Limits) -> float:
    """Desired heading that takes an error away as soon as a gait can.

    A step turns by a share of the bearing that it is planned for: asked for
    more, it turns by the whole error at once, up to what the sharpest turn
    is.

    Args:
        error: Heading that is missed, in [rad].
        limits: Of the own gait.
    """
    share = limits.gain * limits.stride / limits.speed
    asked = wrap_angle(error) / share
    return min(max(asked, -SHARPEST), SHARPEST)


def clearance_of(
    approach: Approach,
    limits: Limits,
    heading: float,
    *,
    stands: bool,
) -> float:
    """Least distance to somebody who walks on while this robot steps aside.

    Args:
        approach: The other.
        limits: Of the own gait, which walks backward.
        heading: Where to turn to, in the own frame, in [rad].
        stands: Whether the first step has to be begun yet.

    Returns:
        Least distance from now on, in [m].
    """
    share = limits.gain * limits.stride / limits.speed
    step = limits.step_duration
    x, y, u, v = approach
    theta = 0.0
    least = approach.distance
    for i in range(LOOKED):
        dx, dy = step * u, step * v
        if i > 0 or not stands:
            turn = share * swift_heading(heading - theta, limits)
            middle = theta + 0.5 * turn
            dx += limits.stride * cos(middle)
            dy += limits.stride * sin(middle)
            theta += turn
        least = min(least, _nearest(x, y, dx, dy))
        x, y = x + dx, y + dy
    return least


def _nearest(x: float, y: float, dx: float, dy: float) -> float:
    """Least distance of a way from the origin, in [m]."""
    square = dx * dx + dy * dy
    if square == 0.0:
        return hypot(x, y)
    share = min(1.0, max(0.0, -(x * dx + y * dy) / square))
    return hypot(x + share * dx, y + share * dy)
