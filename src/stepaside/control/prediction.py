"""The line of sight as it will be when a maneuver takes effect."""

from ..poses import wrap_angle


class LineOfSightPrediction:
    """Extrapolates the direction of the other robot in odometry.

    A foot that lands already stands for the body half a step later, and the
    joints answer late: a plan made from the line of sight of now turns by
    too little for one that rotates, and the circle grows.
    """

    def __init__(self, lead: float, blend: float) -> None:
        """Begin without a rate.

        Args:
            lead: How far ahead to look, in [s].
            blend: Weight of the newest rate in the mean.
        """
        self._lead, self._blend = lead, blend
        self._last: tuple[float, float] | None = None
        self._rate = 0.0

    def ahead(self, time: float, direction: float) -> float:
        """Direction after the lead.

        Args:
            time: When the direction was seen, in [s].
            direction: Of the other in odometry, in [rad].

        Returns:
            Direction, in [rad].
        """
        if self._last is not None and time > self._last[0]:
            passed = time - self._last[0]
            rate = wrap_angle(direction - self._last[1]) / passed
            # A gap says nothing about the rate of now.
            self._rate += self._blend * (rate - self._rate)
            if passed > 2.0:
                self._rate = 0.0
        self._last = time, direction
        return direction + self._rate * self._lead
