"""Approach of an opponent: time to contact, and clearance that is left."""

from math import atan2, cos, hypot, inf, sin, sqrt
from typing import NamedTuple

from .knowledge import Knowledge, Limits

STILL = 0.05  # speed below which the opponent counts as still, in [m/s]
HORIZON = 24  # steps of the prediction that chooses a side


class Approach(NamedTuple):
    """Motion of the opponent in the own frame, or relative to a player."""

    x: float  # position ahead [m]
    y: float  # position to the left [m]
    u: float  # velocity over the floor, component ahead [m/s]
    v: float  # velocity over the floor, component to the left [m/s]

    @classmethod
    def of(cls, knowledge: Knowledge) -> "Approach":
        """Extrapolate the last sighting; at rest if without velocity."""
        u, v = knowledge.velocity or (0.0, 0.0)
        (x, y), age = knowledge.position, knowledge.age
        return cls(x + age * u, y + age * v, u, v)

    @property
    def speed(self) -> float:
        """Speed of the opponent, in [m/s]."""
        return hypot(self.u, self.v)

    @property
    def origin(self) -> float:
        """Direction from which it approaches, or is seen if still [rad]."""
        if self.speed < STILL:
            return atan2(self.y, self.x)
        return atan2(-self.v, -self.u)

    def contact_time(self, clearance: float) -> float:
        """Return the time [s] until the opponent is within a clearance [m].

        Infinite for one that passes, or recedes from, a robot that stands.
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

    def predicted_clearance(
        self, limits: Limits, heading: float, *, stands: bool
    ) -> float:
        """Predict the least distance to an opponent from now on, in [m].

        The opponent keeps its velocity; the robot turns to a heading in its
        frame [rad] and walks backward, after a step if it stands.
        """
        (x, y, u, v), theta = self, 0.0
        share, step, least = limits.share, limits.step_duration, hypot(x, y)
        for i in range(HORIZON):
            dx, dy = step * u, step * v
            if i > 0 or not stands:
                turn = share * limits.correcting_heading(heading - theta)
                middle = theta + 0.5 * turn
                dx += limits.stride * cos(middle)
                dy += limits.stride * sin(middle)
                theta += turn
            least = min(least, _nearest(x, y, dx, dy))
            x, y = x + dx, y + dy
        return least


def _nearest(x: float, y: float, dx: float, dy: float) -> float:
    """Return the least distance of a segment from the origin, in [m]."""
    square = dx * dx + dy * dy
    if square == 0.0:
        return hypot(x, y)
    share = min(1.0, max(0.0, -(x * dx + y * dy) / square))
    return hypot(x + share * dx, y + share * dy)
