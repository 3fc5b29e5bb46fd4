"""Settings of a simulated body: servo, sensor and mass errors.

``docs/walking.md`` gives the source of published values, and marks the others
as assumptions, with a table of their effects.
"""

from dataclasses import dataclass, replace
from math import pi, radians
from typing import ClassVar

from ..core.ranges import Range, Ranges, check_settings
from .physics_settings import PhysicsSettings

SENSOR = "some hundred times NAO's; beyond, a sensor is useless"


@dataclass(frozen=True, slots=True)
class BodySettings:
    """Errors of a real body; each default is ideal.

    Attributes:
        cycle: Control period of the body, in [s]; 0 uses that of the physics
            settings; 0 to 0.1.
        delay_cycles: Control cycles from a command to the motion; 0 to 100.
        imu_delay_cycles: Control cycles by which gyro and accelerometer lag; 0
            to 100.
        torque_speed: Whether a motor's torque falls with its speed, to zero
            at the no-load speed.
        efficiency: Fraction of the motor's ideal stall torque at the joint;
            0.01 to 1.
        stiffness: Torque limit set by the robot, as a fraction of the former;
            0 to 1.
        servo_gain: Factor on the servos' position gain; 0.01 to 10.
        backlash: Width of the dead zone of each leg joint, in [rad]; 0 to 0.2.
        encoder_step: Resolution of the encoders, in [rad]; 1e-09 to 0.1 or
            0.
        gyro_noise: Standard deviation of a reading, in [rad/s]; 0 to 10.
        gyro_bias: Largest constant error, in [rad/s]; 0 to 10.
        accelerometer_noise: Standard deviation, in [m/s^2]; 0 to 100.
        accelerometer_bias: Largest constant error, in [m/s^2]; 0 to 100.
        force_noise: Standard deviation of a foot force, in [N], for a robot
            of NAO's weight; it scales with the weight; 0 to 1000.
        force_gain_error: Largest relative error of each foot force; 0 to 1.
        mass_error: Largest relative error of the mass of each link; 0 to 0.9.
        com_error: Largest horizontal shift of the torso's CoM on each axis,
            in [m], for a robot of NAO's size; it scales with the height of
            the CoM; 0 to 0.1.
    """

    cycle: float = 0.0
    delay_cycles: int = 0
    imu_delay_cycles: int = 0
    torque_speed: bool = False
    efficiency: float = 1.0
    stiffness: float = 1.0
    servo_gain: float = 1.0
    backlash: float = 0.0
    encoder_step: float = 0.0
    gyro_noise: float = 0.0
    gyro_bias: float = 0.0
    accelerometer_noise: float = 0.0
    accelerometer_bias: float = 0.0
    force_noise: float = 0.0
    force_gain_error: float = 0.0
    mass_error: float = 0.0
    com_error: float = 0.0

    ranges: ClassVar[Ranges] = {
        "cycle": Range(
            0.0, 0.1, "s", "balance needs more than ten cycles a second"
        ),
        "delay_cycles": Range(0, 100, "cycles", "a second on NAO", whole=True),
        "imu_delay_cycles": Range(
            0, 100, "cycles", "a second on NAO", whole=True
        ),
        "efficiency": Range(0.01, 1.0, "1", "a fraction of the ideal torque"),
        "stiffness": Range(0.0, 1.0, "1", "a fraction; at 0 joints are limp"),
        "servo_gain": Range(0.01, 10.0, "1", "stiffer servos oscillate"),
        "backlash": Range(0.0, 0.2, "rad", "more means a broken gear"),
        "encoder_step": Range(
            1e-9, 0.1, "rad", "finer is the rounding of a double", also=(0.0,)
        ),
        "gyro_noise": Range(0.0, 10.0, "rad/s", SENSOR),
        "gyro_bias": Range(0.0, 10.0, "rad/s", SENSOR),
        "accelerometer_noise": Range(0.0, 100.0, "m/s^2", SENSOR),
        "accelerometer_bias": Range(0.0, 100.0, "m/s^2", SENSOR),
        "force_noise": Range(0.0, 1000.0, "N", SENSOR),
        "force_gain_error": Range(0.0, 1.0, "1", "a gain is not negative"),
        "mass_error": Range(
            0.0, 0.9, "1", "the mass of a link stays positive"
        ),
        "com_error": Range(0.0, 0.1, "m", "half the depth of the torso"),
    }

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self)

    @property
    def has_ideal_servos(self) -> bool:
        """Whether servos follow commands without delay or error."""
        return self.servo_values == BodySettings().servo_values

    @property
    def has_sensor_errors(self) -> bool:
        """Whether sensors have noise, bias, resolution or delay."""
        values = [getattr(self, name) for name in _SENSORS]
        return self.imu_delay_cycles > 0 or any(v > 0.0 for v in values)

    @property
    def servo_values(self) -> tuple[float, ...]:
        """Settings that affect the servos."""
        return (
            self.delay_cycles,
            self.torque_speed,
            self.efficiency,
            self.stiffness,
            self.servo_gain,
            self.backlash,
        )


_SENSORS = (
    "encoder_step",
    "gyro_noise",
    "gyro_bias",
    "accelerometer_noise",
    "accelerometer_bias",
    "force_noise",
    "force_gain_error",
)

BODIES = {
    "ideal": BodySettings(),
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


def with_control_period(
    physics: PhysicsSettings, body: BodySettings
) -> PhysicsSettings:
    """Return physics settings with the control period of a body.

    Raises:
        ConfigurationError: If the period is no multiple of the time step.
    """
    return replace(physics, tick=body.cycle) if body.cycle > 0.0 else physics
