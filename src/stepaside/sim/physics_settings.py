"""Settings of the world: physics, clock, and the ideal sight."""

from dataclasses import dataclass
from math import inf, pi
from typing import ClassVar

from ..core.errors import ConfigurationError
from ..core.ranges import Range, Ranges, check_settings


@dataclass(frozen=True, slots=True)
class PhysicsSettings:
    """Physics and its clock.

    Attributes:
        time_step: Step of the physics, in [s]; 1e-05 to 0.01.
        tick: Control period, a whole multiple of the time step, in [s]; 1e-05
            to 0.1.
        friction: Sliding friction of the soles on the floor; 1e-06 to 100.
        unevenness: Height of the floor from its lowest to its highest place,
            in [m]; 0 to 0.1.
        slope: Slope of the floor, in [rad]; 0 to 0.5.
        slope_direction: Where the slope descends to, in [rad]; -3.14159 to
            3.14159.
    """

    time_step: float = 0.002
    tick: float = 0.004
    friction: float = 0.8
    unevenness: float = 0.0
    slope: float = 0.0
    slope_direction: float = 0.0

    ranges: ClassVar[Ranges] = {
        "time_step": Range(
            1e-5, 0.01, "s", "contacts leap beyond 10 ms; below, it never ends"
        ),
        "tick": Range(1e-5, 0.1, "s", "nobody balances ten times a second"),
        "friction": Range(1e-6, 100.0, "1", "MuJoCo takes none below"),
        "unevenness": Range(0.0, 0.1, "m", "higher bumps are walls to a NAO"),
        "slope": Range(0.0, 0.5, "rad", "soles slide off what is steeper"),
        "slope_direction": Range(-pi, pi, "rad", "half a turn"),
    }

    def __post_init__(self) -> None:
        """Refuse clocks that do not mesh."""
        check_settings(self)
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
        bearing_noise: Standard deviation of the bearing, in [rad]; 0 to
            3.14159.
        distance_noise: Standard deviation of the distance, in [m]; 0 to 100.
        delay: Time from seeing to knowing, in [s]; 0 to 2.
        rate: Sightings per second, in [1/s]; inf for one every tick; 0.001 to
            1e+06 or inf.
    """

    bearing_noise: float = 0.0
    distance_noise: float = 0.0
    delay: float = 0.0
    rate: float = inf

    ranges: ClassVar[Ranges] = {
        "bearing_noise": Range(0.0, pi, "rad", "more is no bearing at all"),
        "distance_noise": Range(0.0, 100.0, "m", "as far as a start may be"),
        "delay": Range(0.0, 2.0, "s", "what a robot remembers of its way"),
        "rate": Range(
            *(1e-3, 1e6, "1/s"),
            "from three a walk to more than there are ticks",
            also=(inf,),
        ),
    }

    def __post_init__(self) -> None:
        """Refuse negative noise, delays longer than the memory, no rate."""
        check_settings(self)
