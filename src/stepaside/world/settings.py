"""Settings of the world: physics, clock, and the ideal sight."""

from dataclasses import dataclass
from math import inf, isinf, pi

from ..errors import (
    ConfigurationError,
    check_not_negative,
    check_positive,
    check_within,
)

ERROR = ConfigurationError


@dataclass(frozen=True, slots=True)
class PhysicsSettings:
    """Physics and its clock.

    Attributes:
        time_step: Step of the physics, in [s].
        tick: Control period, a whole multiple of the time step, in [s].
        friction: Sliding friction of the soles on the floor.
        unevenness: Height of the floor from its lowest to its highest
            place, in [m].
        slope: Slope of the floor, in [rad].
        slope_direction: Where the slope descends to, in [rad].
    """

    time_step: float = 0.002
    tick: float = 0.004
    friction: float = 0.8
    unevenness: float = 0.0
    slope: float = 0.0
    slope_direction: float = 0.0

    def __post_init__(self) -> None:
        """Refuse clocks that do not mesh."""
        check_within(self.time_step, 1e-5, 0.01, "time_step", "s", ERROR)
        check_within(self.tick, 1e-5, 0.1, "tick", "s", ERROR)
        check_positive(self.friction, "friction", "1", ERROR)
        check_within(self.friction, 1e-6, 100.0, "friction", "1", ERROR)
        check_within(self.unevenness, 0.0, 0.1, "unevenness", "m", ERROR)
        check_within(self.slope, 0.0, 0.5, "slope", "rad", ERROR)
        check_within(
            self.slope_direction, -pi, pi, "slope_direction", "rad", ERROR
        )
        ratio = self.tick / self.time_step
        if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-9 * ratio:
            raise ConfigurationError(
                "tick must be a whole multiple of time_step, "
                f"{self.time_step:g} [s], got {self.tick:g}"
            )

    @property
    def steps_per_tick(self) -> int:
        """Physics steps in one control tick."""
        return round(self.tick / self.time_step)


@dataclass(frozen=True, slots=True)
class SightSettings:
    """The ideal line of sight: the truth, spoilt as much as asked.

    Attributes:
        bearing_noise: Standard deviation of the bearing, in [rad].
        distance_noise: Standard deviation of the distance, in [m].
        delay: Time from seeing to knowing, in [s].
        rate: Sightings per second, in [1/s]; inf for one every tick.
    """

    bearing_noise: float = 0.0
    distance_noise: float = 0.0
    delay: float = 0.0
    rate: float = inf

    def __post_init__(self) -> None:
        """Refuse negative noise, delays longer than the memory, no rate."""
        check_not_negative(self.bearing_noise, "bearing_noise", "rad", ERROR)
        check_not_negative(self.distance_noise, "distance_noise", "m", ERROR)
        check_within(self.delay, 0.0, 2.0, "delay", "s", ERROR)
        if not isinf(self.rate) or self.rate < 0.0:
            check_positive(self.rate, "rate", "1/s", ERROR)
