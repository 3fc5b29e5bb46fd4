"""Settings of a simulated body: servo, sensor and mass errors.

``docs/walking.md`` gives the source of published values, and marks the others
as assumptions, with a table of their effects.
"""

from dataclasses import dataclass, replace
from math import pi, radians

from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting

SENSOR = "some hundred times NAO's; beyond, a sensor is useless"


@dataclass(frozen=True, slots=True)
class BodySettings(CheckedSettings):
    """Errors of a real body; each default is ideal."""

    cycle: float = setting(
        0.0,
        "Control period of the body {unit}; 0 for the tick of the physics",
        Range(0.0, 0.1, "s", "balance needs more than ten cycles a second"),
    )
    delay_cycles: int = setting(
        0,
        "Delay from command to motion, in control cycles",
        Range(0, 100, "cycles", "a second on NAO", whole=True),
    )
    imu_delay_cycles: int = setting(
        0,
        "Delay of gyro and accelerometer, in control cycles",
        Range(0, 100, "cycles", "a second on NAO", whole=True),
    )
    torque_speed: bool = setting(
        False,
        "Reduce motor torque with speed, to zero at the no-load speed",
    )
    efficiency: float = setting(
        1.0,
        "Joint stall torque, as a fraction of the ideal one",
        Range(0.01, 1.0, "1", "a fraction of the ideal torque"),
    )
    stiffness: float = setting(
        1.0,
        "Stiffness setting: fraction of the stall torque allowed",
        Range(0.0, 1.0, "1", "a fraction; at 0 joints are limp"),
    )
    servo_gain: float = setting(
        1.0,
        "Scale factor of the servo position gain",
        Range(0.01, 10.0, "1", "stiffer servos oscillate"),
    )
    backlash: float = setting(
        0.0,
        "Backlash of each leg joint",
        Range(0.0, 0.2, "rad", "more means a broken gear"),
    )
    encoder_step: float = setting(
        0.0,
        "Resolution of the encoders",
        Range(
            1e-9, 0.1, "rad", "finer is the rounding of a double", also=(0.0,)
        ),
    )
    gyro_noise: float = setting(
        0.0,
        "Standard deviation of the gyro noise",
        Range(0.0, 10.0, "rad/s", SENSOR),
    )
    gyro_bias: float = setting(
        0.0,
        "Maximum gyro bias",
        Range(0.0, 10.0, "rad/s", SENSOR),
    )
    accelerometer_noise: float = setting(
        0.0,
        "Standard deviation of the accelerometer noise",
        Range(0.0, 100.0, "m/s^2", SENSOR),
    )
    accelerometer_bias: float = setting(
        0.0,
        "Maximum accelerometer bias",
        Range(0.0, 100.0, "m/s^2", SENSOR),
    )
    force_noise: float = setting(
        0.0,
        "Standard deviation of the foot force noise {unit} for a robot of "
        "NAO's weight, with which it scales",
        Range(0.0, 1000.0, "N", SENSOR),
    )
    force_gain_error: float = setting(
        0.0,
        "Maximum relative gain error of a foot force sensor",
        Range(0.0, 1.0, "1", "a gain is not negative"),
    )
    mass_error: float = setting(
        0.0,
        "Maximum relative error of a link mass",
        Range(0.0, 0.9, "1", "the mass of a link stays positive"),
    )
    com_error: float = setting(
        0.0,
        "Maximum offset of the torso CoM along each axis {unit} for a robot "
        "of NAO's size, with which it scales",
        Range(0.0, 0.1, "m", "half the depth of the torso"),
    )

    @property
    def has_ideal_servos(self) -> bool:
        """Whether servos follow commands without delay or error."""
        return not self._differs(
            *("delay_cycles", "torque_speed", "efficiency"),
            *("stiffness", "servo_gain", "backlash"),
        )

    @property
    def has_sensor_errors(self) -> bool:
        """Whether sensors have noise, bias, resolution or delay."""
        return self._differs(
            *("imu_delay_cycles", "encoder_step", "gyro_noise", "gyro_bias"),
            *("accelerometer_noise", "accelerometer_bias"),
            *("force_noise", "force_gain_error"),
        )

    def _differs(self, *names: str) -> bool:
        return any(getattr(self, n) != getattr(IDEAL, n) for n in names)


IDEAL = BodySettings()
BODIES = {
    "ideal": IDEAL,
    "delayed": BodySettings(cycle=0.012, delay_cycles=3, imu_delay_cycles=1),
    "hardware": BodySettings(
        cycle=0.012,
        delay_cycles=3,
        imu_delay_cycles=1,
        torque_speed=True,
        efficiency=0.6,
        servo_gain=0.75,
        backlash=radians(1.0),
        encoder_step=2.0 * pi / 4096,
        gyro_noise=0.01,
        gyro_bias=0.01,
        accelerometer_noise=0.2,
        accelerometer_bias=0.1,
        force_noise=0.4,
        force_gain_error=0.1,
        mass_error=0.03,
        com_error=0.003,
    ),
}


def at_tick(body: BodySettings, tick: float) -> BodySettings:
    """Return a body with the same delays, in control ticks [s] of a policy."""
    if body.cycle == 0.0:
        return body
    return replace(
        body,
        cycle=0.0,
        delay_cycles=round(body.delay_cycles * body.cycle / tick),
        imu_delay_cycles=round(body.imu_delay_cycles * body.cycle / tick),
    )
