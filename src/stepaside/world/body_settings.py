"""How far a simulated body is from an ideal one.

Values that teams or the vendor published carry their source in
``docs/walking.md``; the others are marked as assumptions there, with a table
of what they do.
"""

from dataclasses import dataclass, replace
from math import pi, radians

from ..errors import ConfigurationError, check_not_negative, check_within
from .settings import PhysicsSettings

ERROR = ConfigurationError


@dataclass(frozen=True, slots=True)
class BodySettings:
    """Effects of a real body, each at zero or one where it does nothing.

    Attributes:
        cycle: Control period that the body asks for, in [s]; 0 leaves it to
            the physics settings.
        delay_cycles: Control cycles from a request to the motion.
        imu_delay_cycles: Control cycles by which gyro and accelerometer lag.
        torque_speed: Whether a motor's torque falls with its speed, to zero
            at the no-load speed.
        efficiency: Share of the motor's ideal stall torque at the joint.
        stiffness: Torque cap that the robot sets, as a share of the former.
        servo_gain: Factor on the servos' position gain.
        backlash: Width of the dead zone of each leg joint, in [rad].
        encoder_step: Resolution of the encoders, in [rad].
        gyro_noise: Standard deviation of a reading, in [rad/s].
        gyro_bias: Greatest constant error, in [rad/s].
        accelerometer_noise: Standard deviation, in [m/s^2].
        accelerometer_bias: Greatest constant error, in [m/s^2].
        force_noise: Standard deviation of a foot force, in [N].
        force_gain_error: Greatest relative error of each foot force.
        mass_error: Greatest relative error of the mass of each link.
        com_error: Greatest horizontal shift of the torso's CoM on each
            axis, in [m].
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

    def __post_init__(self) -> None:
        """Refuse what no body is."""
        check_within(self.cycle, 0.0, 0.1, "cycle", "s", ERROR)
        for name in ("delay_cycles", "imu_delay_cycles"):
            check_within(getattr(self, name), 0, 100, name, "cycles", ERROR)
        check_within(self.efficiency, 0.01, 1.0, "efficiency", "1", ERROR)
        check_within(self.stiffness, 0.0, 1.0, "stiffness", "1", ERROR)
        check_within(self.servo_gain, 0.01, 10.0, "servo_gain", "1", ERROR)
        check_within(self.backlash, 0.0, 0.2, "backlash", "rad", ERROR)
        check_within(self.mass_error, 0.0, 0.9, "mass_error", "1", ERROR)
        check_within(self.com_error, 0.0, 0.1, "com_error", "m", ERROR)
        for name, unit in _NOT_NEGATIVE.items():
            check_not_negative(getattr(self, name), name, unit, ERROR)

    @property
    def has_ideal_servos(self) -> bool:
        """Whether requests reach the servos at once and unspoilt."""
        return self.servo_values == BodySettings().servo_values

    @property
    def has_sensor_errors(self) -> bool:
        """Whether sensors give anything but the truth of the moment."""
        values = [getattr(self, name) for name in _NOT_NEGATIVE]
        return self.imu_delay_cycles > 0 or any(v > 0.0 for v in values)

    @property
    def servo_values(self) -> tuple[float, ...]:
        """What a servo depends on."""
        return (
            self.delay_cycles,
            self.torque_speed,
            self.efficiency,
            self.stiffness,
            self.servo_gain,
            self.backlash,
        )


_NOT_NEGATIVE = {
    "encoder_step": "rad",
    "gyro_noise": "rad/s",
    "gyro_bias": "rad/s",
    "accelerometer_noise": "m/s^2",
    "accelerometer_bias": "m/s^2",
    "force_noise": "N",
    "force_gain_error": "1",
}

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


def with_cycle(
    physics: PhysicsSettings, body: BodySettings
) -> PhysicsSettings:
    """Physics with the control period that a body asks for.

    Raises:
        ConfigurationError: If the period is no multiple of the time step.
    """
    return replace(physics, tick=body.cycle) if body.cycle > 0.0 else physics
