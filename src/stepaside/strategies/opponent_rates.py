"""How the other moves, from what was seen."""

from collections import deque
from typing import NamedTuple

from ..core.poses import wrap_angle


class SightRateEstimate(NamedTuple):
    """Rates of the line of sight; None where they are not known.

    Attributes:
        bearing_rate: Of its direction on the floor, in [rad/s].
        closing_speed: How fast its length shrinks, in [m/s].
    """

    bearing_rate: float | None
    closing_speed: float | None


class SightRates:
    """Rates over the last gait cycle, from one sighting to another.

    A body that walks sways once in two steps: over a whole cycle the sway
    is out of the difference.
    """

    def __init__(self, step_duration: float) -> None:
        """Begin without a sighting, for steps of a duration, in [s]."""
        self._step = step_duration
        self._seen: deque[tuple[float, float, float]] = deque()

    def note(
        self, time: float, direction: float, distance: float
    ) -> SightRateEstimate:
        """Take a sighting in.

        Sightings that are much closer than a step are thinned out, so that
        no more than a few are kept.

        Args:
            time: When the other was seen, in [s].
            direction: Where, in a frame that does not turn, in [rad].
            distance: How far, in [m].

        Returns:
            Rates since the oldest sighting of the last two steps, unless
            that is less than one step old.
        """
        seen, step = self._seen, self._step
        while seen and time - seen[0][0] > 2.25 * step:
            seen.popleft()
        rates = SightRateEstimate(None, None)
        if seen:
            passed = time - seen[0][0]
            if passed > 0.75 * step:
                turned = wrap_angle(direction - seen[0][1])
                rates = SightRateEstimate(
                    turned / passed, (seen[0][2] - distance) / passed
                )
        if not seen or time - seen[-1][0] >= 0.125 * step:
            seen.append((time, direction, distance))
        return rates


class FloorVelocity:
    """Velocity of the other on the floor over the last three steps.

    It is the slope of the straight line that fits its places best, so that
    sway and one bad sighting count little.
    """

    def __init__(self, step_duration: float) -> None:
        """Begin without a sighting, for steps of a duration, in [s]."""
        self._step = step_duration
        self._seen: deque[tuple[float, float, float]] = deque()

    def note(
        self, time: float, x: float, y: float
    ) -> tuple[float, float] | None:
        """Take a place in.

        Args:
            time: When the other was there, in [s].
            x: Where, in a frame that stays, in [m].
            y: Likewise.

        Returns:
            Velocity in that frame, in [m/s]; None until the places span
            most of a step.
        """
        seen, step = self._seen, self._step
        while seen and time - seen[0][0] > 3.25 * step:
            seen.popleft()
        if not seen or time - seen[-1][0] >= 0.2 * step:
            seen.append((time, x, y))
        if time - seen[0][0] <= 0.75 * step:
            return None
        rows = [*seen, (time, x, y)]
        count = len(rows)
        middle = [sum(row[i] for row in rows) / count for i in range(3)]
        square = along = across = 0.0
        for t, u, v in rows:
            late = t - middle[0]
            square += late * late
            along += late * (u - middle[1])
            across += late * (v - middle[2])
        return along / square, across / square
