"""Options of one robot's body and control, and of what it walks on."""

from collections.abc import Collection
from typing import TYPE_CHECKING

import click

from .declaration import OptionDeclaration, OptionGroup

if TYPE_CHECKING:
    from ...sim.body_settings import BodySettings


def _bodies() -> "dict[str, BodySettings]":
    from ...sim.body_settings import BODIES

    return BODIES


def _methods() -> Collection[str]:
    from ...locomotion.zmp.control_settings import METHODS

    return METHODS


def _tails() -> Collection[str]:
    from ...locomotion.zmp.control_settings import TAILS

    return TAILS


BODY_PRESET = OptionDeclaration(
    "--body",
    "How far the body is from an ideal one.",
    "body",
    registry=_bodies,
)
BODY = OptionGroup(
    "Body (each changes the one that --body names)",
    (
        BODY_PRESET,
        OptionDeclaration(
            "--cycle",
            "Control period {unit} of the body; 0 leaves it to --tick.",
            "body.cycle",
            "s",
        ),
        OptionDeclaration(
            "--delay-cycles",
            "Control cycles from a request to the motion",
            "body.delay_cycles",
            "cycles",
            kind=click.INT,
        ),
        OptionDeclaration(
            "--imu-delay-cycles",
            "Control cycles by which gyro and accelerometer lag",
            "body.imu_delay_cycles",
            "cycles",
            kind=click.INT,
        ),
        OptionDeclaration(
            "--torque-speed/--no-torque-speed",
            "Whether a motor's torque falls with its speed.",
            "body.torque_speed",
        ),
        OptionDeclaration(
            "--efficiency",
            "Share of the ideal stall torque at the joint",
            "body.efficiency",
            "1",
        ),
        OptionDeclaration(
            "--stiffness",
            "Share of that torque that the robot allows",
            "body.stiffness",
            "1",
        ),
        OptionDeclaration(
            "--servo-gain",
            "Factor on the servos' position gain",
            "body.servo_gain",
            "1",
        ),
        OptionDeclaration(
            "--backlash", "Dead zone of each leg joint", "body.backlash", "rad"
        ),
        OptionDeclaration(
            "--encoder-step",
            "Resolution of the encoders",
            "body.encoder_step",
            "rad",
        ),
        OptionDeclaration(
            "--gyro-noise",
            "Standard deviation of the gyro",
            "body.gyro_noise",
            "rad/s",
        ),
        OptionDeclaration(
            "--gyro-bias",
            "Greatest constant error of the gyro",
            "body.gyro_bias",
            "rad/s",
        ),
        OptionDeclaration(
            "--accelerometer-noise",
            "Standard deviation of the accelerometer",
            "body.accelerometer_noise",
            "m/s^2",
        ),
        OptionDeclaration(
            "--accelerometer-bias",
            "Greatest constant error of the accelerometer",
            "body.accelerometer_bias",
            "m/s^2",
        ),
        OptionDeclaration(
            "--force-noise",
            "Standard deviation of a foot force",
            "body.force_noise",
            "N",
        ),
        OptionDeclaration(
            "--force-gain-error",
            "Greatest relative error of a foot force",
            "body.force_gain_error",
            "1",
        ),
        OptionDeclaration(
            "--mass-error",
            "Greatest relative error of a link's mass",
            "body.mass_error",
            "1",
        ),
        OptionDeclaration(
            "--com-error",
            "Greatest shift of the torso's CoM on each axis",
            "body.com_error",
            "m",
        ),
    ),
)
METHOD = OptionDeclaration(
    "--method",
    "Where the CoM comes from: the planned state, the measured one, or "
    "intrinsically stable MPC.",
    "control.method",
    registry=_methods,
)
FEEDBACK = OptionDeclaration(
    "--feedback/--no-feedback",
    "Estimate the state and stabilise the walk, or replay the plans in open "
    "loop; feedback for all bodies but the ideal one by default.",
    "control.feedback",
    tells_default=False,
    more_names=(" /--open-loop",),
)
CONTROL = OptionGroup(
    "Control",
    (
        METHOD,
        FEEDBACK,
        OptionDeclaration(
            "--learn-turns/--no-learn-turns",
            "Learn by the gyro how much of a turn the feet make, and ask for "
            "as much more.",
            "control.learn_turns",
        ),
        OptionDeclaration(
            "--mpc-steps",
            "Steps in the horizon of the MPC",
            "control.mpc.steps",
            "steps",
            kind=click.INT,
        ),
        OptionDeclaration(
            "--mpc-samples",
            "Samples of the MPC in a step",
            "control.mpc.samples",
            "1",
            kind=click.INT,
        ),
        OptionDeclaration(
            "--mpc-tail",
            "What the MPC assumes beyond its horizon.",
            "control.mpc.tail",
            registry=_tails,
        ),
    ),
)
PHYSICS = OptionGroup(
    "Floor and physics",
    (
        OptionDeclaration(
            "--friction",
            "Friction of the soles {unit}; {default} by default.",
            "physics.friction",
            "1",
        ),
        OptionDeclaration(
            "--unevenness",
            "Height {unit} of the floor's bumps.",
            "physics.unevenness",
            "m",
        ),
        OptionDeclaration(
            "--slope", "Slope of the floor", "physics.slope", "rad"
        ),
        OptionDeclaration(
            "--slope-direction",
            "Where the floor descends to",
            "physics.slope_direction",
            "rad",
        ),
        OptionDeclaration(
            "--time-step", "Step of the physics", "physics.time_step", "s"
        ),
        OptionDeclaration(
            "--tick",
            "Control period {unit}, a whole multiple of the time step.",
            "physics.tick",
            "s",
        ),
    ),
)
