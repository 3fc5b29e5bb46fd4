"""Rates of motion of the opponent, from sightings."""

from collections import deque
from typing import NamedTuple

from ..core.poses import wrap_angle


class SightRateEstimate(NamedTuple):
    """Rates of the line of sight; None until they are known.

    Attributes:
        bearing_rate: Turning rate of its direction over the floor, in [rad/s].
        closing_speed: Rate at which its length decreases, in [m/s].
    """

    bearing_rate: float | None
    closing_speed: float | None


class SightRates:
    """Differences of sightings over the last gait cycle.

    A walking body sways once in two steps: over a whole cycle the sway
    cancels.
    """

    def __init__(self, step_duration: float) -> None:
        """Begin without a sighting, for a step duration in [s]."""
        self._step = step_duration
        self._samples: deque[tuple[float, float, float]] = deque()

    def note(
        self, time: float, direction: float, distance: float
    ) -> SightRateEstimate:
        """Add a sighting.

        Sightings much closer in time than a step are thinned out, so that
        only a few are stored.

        Args:
            time: Time of the sighting, in [s].
            direction: Direction of the opponent in a fixed frame, in [rad].
            distance: Distance to the opponent, in [m].

        Returns:
            Rates since the oldest sighting of the last two steps, unless
            that is less than one step old.
        """
        samples, step = self._samples, self._step
        while samples and time - samples[0][0] > 2.25 * step:
            samples.popleft()
        rates = SightRateEstimate(None, None)
        if samples:
            passed = time - samples[0][0]
            if passed > 0.75 * step:
                turned = wrap_angle(direction - samples[0][1])
                rates = SightRateEstimate(
                    turned / passed, (samples[0][2] - distance) / passed
                )
        if not samples or time - samples[-1][0] >= 0.125 * step:
            samples.append((time, direction, distance))
        return rates


class FloorVelocity:
    """Velocity of the opponent over the floor, over the last three steps.

    It is the slope of a least-squares line through its positions, which
    reduces the effect of sway and of outliers.
    """

    def __init__(self, step_duration: float) -> None:
        """Begin without a sighting, for a step duration in [s]."""
        self._step = step_duration
        self._samples: deque[tuple[float, float, float]] = deque()

    def note(
        self, time: float, x: float, y: float
    ) -> tuple[float, float] | None:
        """Add a position.

        Args:
            time: Time of the sighting, in [s].
            x: Position of the opponent in a fixed frame, in [m].
            y: Likewise.

        Returns:
            Velocity in that frame, in [m/s]; None until the positions span
            most of a step.
        """
        samples, step = self._samples, self._step
        while samples and time - samples[0][0] > 3.25 * step:
            samples.popleft()
        if not samples or time - samples[-1][0] >= 0.2 * step:
            samples.append((time, x, y))
        if time - samples[0][0] <= 0.75 * step:
            return None
        rows = [*samples, (time, x, y)]
        count = len(rows)
        middle = [sum(column) / count for column in zip(*rows, strict=True)]
        square = along = across = 0.0
        for t, u, v in rows:
            dt = t - middle[0]
            square += dt * dt
            along += dt * (u - middle[1])
            across += dt * (v - middle[2])
        return along / square, across / square
