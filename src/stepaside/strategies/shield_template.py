"""Point that follows the commands of learned legs at once.

A body that follows commands with a lag comes to rest at its position plus the
lag times its velocity. The template point moves with the commanded velocity,
and towards that place of rest by no more than a loss per period. So what legs
do otherwise than told displaces the point slowly, and the distance of the body
from it is bounded: the tube that ``robot legs measure`` finds.
"""

from math import hypot
from typing import NamedTuple

from .velocity_set import response_share

LEGS_PERIOD = 0.48  # of the motions of legs: several cells of the grid, [s]
# Per period, in [m]; with it a G1 with 29 joints has a tube of 0.28 m.
LEGS_LOSS = 0.08

Vector = tuple[float, float]


class TemplatePoint(NamedTuple):
    """Template point of a body on learned legs.

    Attributes:
        position: Its position in the map, in [m].
        drift: Velocity of the body over the floor, by the lag of its legs, in
            [m/s].
    """

    position: Vector
    drift: Vector = (0.0, 0.0)

    def advance(
        self, command: Vector, body: Vector, lag: float, duration: float
    ) -> "TemplatePoint":
        """Return the point a duration [s] later, at a position of the body.

        The velocity over the floor is commanded, and legs lag by ``lag``.
        """
        (u, v), share = self.drift, response_share(duration, lag)
        drift = u + share * (command[0] - u), v + share * (command[1] - v)
        x = self.position[0] + duration * command[0]
        y = self.position[1] + duration * command[1]
        dx = body[0] + lag * drift[0] - x
        dy = body[1] + lag * drift[1] - y
        most = LEGS_LOSS * duration / LEGS_PERIOD
        share = min(1.0, most / max(hypot(dx, dy), 1e-12))
        return TemplatePoint((x + share * dx, y + share * dy), drift)
