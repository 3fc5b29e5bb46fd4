"""Somebody who comes and goes, again and again."""

from math import atan2, cos, hypot, pi, sin

from ..core.poses import wrap_angle

AROUND = 4.5  # distance at which nobody is near any more, in [m]
GOLDEN = 2.399963  # from one direction of coming to the next, in [rad]
SHARE = 0.618034  # of the width, from one aim to the next
WIDE = 1.5  # how far beside the robot somebody aims, at most, in [m]
ARRIVED = 0.1  # of the way around that is left, in [rad]
SLOPE = 0.5  # of the way around to the circle, at most, in [rad]
Place = tuple[float, float]


class RepeatedVisits:
    """Where somebody walks who crosses the room once and again.

    Each crossing aims past the evader, where it is by then, at up to 1.5 m;
    directions and aims follow the golden ratio, so that they come from
    everywhere, and the same way each time it is played. In between the
    person walks around, out of sight of a depth camera.

    Attributes:
        number: Crossings begun.
        miss: How far to the left of the evader the last one aims, in [m].
        crossing: Whether one is under way.
    """

    def __init__(self, miss: float) -> None:
        """Begin with a crossing that aims so far beside the evader."""
        self.number, self.miss, self.crossing = 1, miss, True

    def course(self, here: Place, course: float, evader: Place) -> float:
        """Where to walk next, in [rad].

        Args:
            here: Where the person is, in [m].
            course: Where the person walks to now, in [rad].
            evader: Place of the evader, in [m].
        """
        dx, dy = here[0] - evader[0], here[1] - evader[1]
        away, angle = hypot(dx, dy), atan2(dy, dx)
        if self.crossing:
            leaves = dx * cos(course) + dy * sin(course) > 0.0
            if not (leaves and away > AROUND):
                return course
            self.crossing = False
        left = wrap_angle(self.number * GOLDEN - angle)
        if abs(left) < ARRIVED:
            self.number, self.crossing = self.number + 1, True
            self.miss = WIDE * (2.0 * (SHARE * self.number % 1.0) - 1.0)
            ahead = angle + pi
            return atan2(
                self.miss * cos(ahead) - dy, -self.miss * sin(ahead) - dx
            )
        side = 1.0 if left > 0.0 else -1.0
        inward = min(max(away - AROUND, -SLOPE), SLOPE)
        return angle + side * (0.5 * pi + inward)
