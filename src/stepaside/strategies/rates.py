"""How fast the line of sight turns and shortens, from what was seen."""

from collections import deque
from typing import NamedTuple

from ..poses import wrap_angle


class Rates(NamedTuple):
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

    def note(self, time: float, direction: float, distance: float) -> Rates:
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
        rates = Rates(None, None)
        if seen:
            passed = time - seen[0][0]
            if passed > 0.75 * step:
                turned = wrap_angle(direction - seen[0][1])
                rates = Rates(
                    turned / passed, (seen[0][2] - distance) / passed
                )
        if not seen or time - seen[-1][0] >= 0.125 * step:
            seen.append((time, direction, distance))
        return rates
