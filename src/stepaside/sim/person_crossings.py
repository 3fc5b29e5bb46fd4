"""Repeated visits of a person who crosses the room past the evader."""

from math import atan2, cos, hypot, pi, sin

from ..core.poses import wrap_angle

RADIUS = 4.5  # of the walk around the evader between visits, in [m]
GOLDEN_ANGLE = 2.399963  # between the directions of two visits, in [rad]
GOLDEN_RATIO = 0.618034  # step of the lateral offset, relative to its range
MAX_MISS = 1.5  # largest lateral offset of a visit, in [m]
ARRIVED = 0.1  # remaining angle at which the next visit starts, in [rad]
MAX_SLOPE = 0.5  # of the walk towards the circle, in [rad]
Place = tuple[float, float]


class RepeatedCrossings:
    """Course of a person who crosses the room repeatedly.

    Each visit aims past the current position of the evader at up to 1.5 m.
    Directions and offsets follow the golden ratio, so they cover all cases
    and are the same in every game. Between visits the person walks around
    the evader, beyond the range of a depth camera.

    Attributes:
        number: Number of visits started.
        miss: Lateral offset of the last visit to the left of the evader, in
            [m].
        crossing: Whether a visit is in progress.
    """

    def __init__(self, miss: float) -> None:
        """Start with a visit at a lateral offset, in [m]."""
        self.number, self.miss, self.crossing = 1, miss, True

    def course(self, here: Place, course: float, evader: Place) -> float:
        """Return the next course in the world, in [rad].

        Args:
            here: Position of the person in the world, in [m].
            course: Current course in the world, in [rad].
            evader: Position of the evader in the world, in [m].
        """
        dx, dy = here[0] - evader[0], here[1] - evader[1]
        distance, angle = hypot(dx, dy), atan2(dy, dx)
        if self.crossing:
            leaves = dx * cos(course) + dy * sin(course) > 0.0
            if not (leaves and distance > RADIUS):
                return course
            self.crossing = False
        left = wrap_angle(self.number * GOLDEN_ANGLE - angle)
        if abs(left) < ARRIVED:
            self.number, self.crossing = self.number + 1, True
            self.miss = MAX_MISS * (
                2.0 * (GOLDEN_RATIO * self.number % 1.0) - 1.0
            )
            ahead = angle + pi
            return atan2(
                self.miss * cos(ahead) - dy, -self.miss * sin(ahead) - dx
            )
        side = 1.0 if left > 0.0 else -1.0
        inward = min(max(distance - RADIUS, -MAX_SLOPE), MAX_SLOPE)
        return angle + side * (0.5 * pi + inward)
