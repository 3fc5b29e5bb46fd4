"""Pursuit that cuts the evader off from the centre of a room."""

from dataclasses import dataclass, field, replace
from math import atan2, cos, hypot, sin

from ..core.poses import wrap_angle
from .knowledge import Intent, Knowledge
from .pursuit import Pursuit, PursuitVariant

NEAR = 1e-6  # distance from the centre at which it has no bearing, in [m]


@dataclass(frozen=True, slots=True)
class HerdingPursuit(PursuitVariant):
    """Pursuer that heads between the evader and the centre of the room.

    Its target point divides the segment from the evader to the centre in
    the ratio of the pursuer's distances to both: its bearing bisects the
    two. So the pursuer stays between the evader and the free floor, and
    drives the evader to the walls.

    Attributes:
        center: Centre of the room (x, y) in the frame of
            ``Knowledge.pose_in_map``, in [m]. The origin of a known room is
            its centre; without a known room the frame is odometry, whose
            origin was the initial pose of the pursuer.
        pursuit: Pursuit of the target point.
    """

    center: tuple[float, float] = (0.0, 0.0)
    pursuit: Pursuit = field(default_factory=Pursuit)

    def decide(
        self, knowledge: Knowledge, memory: int | None
    ) -> tuple[Intent, int | None]:
        """Head for the point between the evader and the centre."""
        x, y, theta = knowledge.pose_in_map
        u, v = self.center[0] - x, self.center[1] - y
        inward = hypot(u, v)
        if inward < NEAR:
            return self.pursuit.decide(knowledge, memory)
        sight = theta + knowledge.bearing
        # The sum of two unit vectors halves the angle between them.
        dx, dy = cos(sight) + u / inward, sin(sight) + v / inward
        away = knowledge.distance
        aimed = replace(
            knowledge,
            bearing=wrap_angle(atan2(dy, dx) - theta),
            distance=hypot(dx, dy) * away * inward / (away + inward),
        )
        return self.pursuit.decide(aimed, memory)
