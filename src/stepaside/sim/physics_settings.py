"""Settings of the physics and of the ideal line of sight."""

from dataclasses import dataclass
from math import inf, pi

from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting

INTEGRATORS = ("implicitfast", "discrete")  # of MuJoCo


@dataclass(frozen=True, slots=True)
class PhysicsSettings(CheckedSettings):
    """Settings of the physics, its time steps and the floor."""

    time_step: float = setting(
        0.002,
        "Integration step of the physics",
        Range(1e-5, 0.01, "s", "contacts fail above 10 ms; below, too slow"),
    )
    tick: float = setting(
        0.004,
        "Control period {unit}; an integer multiple of the time step",
        Range(1e-5, 0.1, "s", "balance needs more than ten cycles a second"),
    )
    integrator: str = setting(
        "implicitfast",
        "Integrator of the physics; discrete allows twice the time step, "
        "at half the cost",
        names=INTEGRATORS,
    )
    friction: float = setting(
        0.8,
        "Coefficient of friction between soles and floor",
        Range(1e-6, 100.0, "1", "the minimum of MuJoCo"),
    )
    unevenness: float = setting(
        0.0,
        "Height difference between the lowest and the highest point of the "
        "floor",
        Range(0.0, 0.1, "m", "a NAO cannot step over more"),
    )
    slope: float = setting(
        0.0,
        "Slope of the floor",
        Range(0.0, 0.5, "rad", "soles slide on more"),
    )
    slope_direction: float = setting(
        0.0,
        "Direction of steepest descent in the world",
        Range(-pi, pi, "rad", "half a turn"),
    )


@dataclass(frozen=True, slots=True)
class SightSettings(CheckedSettings):
    """Settings of the ideal line of sight."""

    bearing_noise: float = setting(
        0.0,
        "Standard deviation of the bearing of a sighting",
        Range(0.0, pi, "rad", "more is no measurement"),
    )
    distance_noise: float = setting(
        0.0,
        "Standard deviation of the distance of a sighting",
        Range(0.0, 100.0, "m", "the largest initial distance"),
    )
    delay: float = setting(
        0.0,
        "Latency of a sighting",
        Range(0.0, 2.0, "s", "how long a robot stores its poses"),
    )
    rate: float = setting(
        inf,
        "Rate of sightings {unit}; inf for one every tick",
        Range(
            1e-3,
            1e6,
            "1/s",
            "from one in a walk to many in a tick",
            also=(inf,),
        ),
    )
