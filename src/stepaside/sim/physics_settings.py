"""Settings of the physics and of the ideal line of sight."""

from dataclasses import dataclass
from math import inf, pi
from typing import ClassVar

from ..core.errors import ConfigurationError
from ..core.ranges import Range, Ranges, check_settings


@dataclass(frozen=True, slots=True)
class PhysicsSettings:
    """Settings of the physics, its time steps and the floor.

    Attributes:
        time_step: Time step of the physics, in [s]; 1e-05 to 0.01.
        tick: Control period, a multiple of the time step, in [s]; 1e-05 to
            0.1.
        friction: Sliding friction of the soles on the floor; 1e-06 to 100.
        unevenness: Height difference of the lowest and the highest point of
            the floor, in [m]; 0 to 0.1.
        slope: Slope of the floor, in [rad]; 0 to 0.5.
        slope_direction: Direction of descent in the world, in [rad]; -3.14159
            to 3.14159.
    """

    time_step: float = 0.002
    tick: float = 0.004
    friction: float = 0.8
    unevenness: float = 0.0
    slope: float = 0.0
    slope_direction: float = 0.0

    ranges: ClassVar[Ranges] = {
        "time_step": Range(
            1e-5, 0.01, "s", "contacts fail above 10 ms; below, too slow"
        ),
        "tick": Range(
            1e-5, 0.1, "s", "balance needs more than ten cycles a second"
        ),
        "friction": Range(1e-6, 100.0, "1", "the minimum of MuJoCo"),
        "unevenness": Range(0.0, 0.1, "m", "a NAO cannot step over more"),
        "slope": Range(0.0, 0.5, "rad", "soles slide on more"),
        "slope_direction": Range(-pi, pi, "rad", "half a turn"),
    }

    def __post_init__(self) -> None:
        """Check the ranges, and the ratio of the periods."""
        check_settings(self)
        ratio = self.tick / self.time_step
        if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-9 * ratio:
            raise ConfigurationError(
                "tick must be a whole multiple of time_step, "
                f"{self.time_step:g} [s], got {self.tick:g}"
            )

    @property
    def steps_per_tick(self) -> int:
        """Number of physics steps per control tick."""
        return round(self.tick / self.time_step)


@dataclass(frozen=True, slots=True)
class SightSettings:
    """Settings of the ideal line of sight.

    Attributes:
        bearing_noise: Standard deviation of the bearing, in [rad]; 0 to
            3.14159.
        distance_noise: Standard deviation of the distance, in [m]; 0 to 100.
        delay: Latency of a sighting, in [s]; 0 to 2.
        rate: Rate of sightings, in [1/s]; inf for one every tick; 0.001 to
            1e+06 or inf.
    """

    bearing_noise: float = 0.0
    distance_noise: float = 0.0
    delay: float = 0.0
    rate: float = inf

    ranges: ClassVar[Ranges] = {
        "bearing_noise": Range(0.0, pi, "rad", "more is no measurement"),
        "distance_noise": Range(
            0.0, 100.0, "m", "the largest initial distance"
        ),
        "delay": Range(0.0, 2.0, "s", "how long a robot stores its poses"),
        "rate": Range(
            1e-3,
            1e6,
            "1/s",
            "from one in a walk to many in a tick",
            also=(inf,),
        ),
    }

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self)
