"""Options for the body, the control and the floor of a simulated robot."""

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
    "Imperfections of the body: none, delays only, or those of real hardware.",
    "body",
    registry=_bodies,
)
BODY = OptionGroup(
    "Body (each option modifies the preset of --body)",
    (
        BODY_PRESET,
        OptionDeclaration(
            "--cycle",
            "Control period of the body {unit}; 0 for the period of --tick.",
            "body.cycle",
            "s",
        ),
        OptionDeclaration(
            "--delay-cycles",
            "Delay from command to motion, in control cycles",
            "body.delay_cycles",
            "cycles",
            kind=click.INT,
        ),
        OptionDeclaration(
            "--imu-delay-cycles",
            "Delay of gyro and accelerometer, in control cycles",
            "body.imu_delay_cycles",
            "cycles",
            kind=click.INT,
        ),
        OptionDeclaration(
            "--torque-speed/--no-torque-speed",
            "Reduce motor torque with speed.",
            "body.torque_speed",
        ),
        OptionDeclaration(
            "--efficiency",
            "Joint stall torque, as a fraction of the ideal one",
            "body.efficiency",
            "1",
        ),
        OptionDeclaration(
            "--stiffness",
            "Stiffness setting: fraction of the stall torque allowed",
            "body.stiffness",
            "1",
        ),
        OptionDeclaration(
            "--servo-gain",
            "Scale factor of the servo position gain",
            "body.servo_gain",
            "1",
        ),
        OptionDeclaration(
            "--backlash", "Backlash of each leg joint", "body.backlash", "rad"
        ),
        OptionDeclaration(
            "--encoder-step",
            "Resolution of the encoders",
            "body.encoder_step",
            "rad",
        ),
        OptionDeclaration(
            "--gyro-noise",
            "Standard deviation of the gyro noise",
            "body.gyro_noise",
            "rad/s",
        ),
        OptionDeclaration(
            "--gyro-bias",
            "Maximum gyro bias",
            "body.gyro_bias",
            "rad/s",
        ),
        OptionDeclaration(
            "--accelerometer-noise",
            "Standard deviation of the accelerometer noise",
            "body.accelerometer_noise",
            "m/s^2",
        ),
        OptionDeclaration(
            "--accelerometer-bias",
            "Maximum accelerometer bias",
            "body.accelerometer_bias",
            "m/s^2",
        ),
        OptionDeclaration(
            "--force-noise",
            "Standard deviation of the foot force noise",
            "body.force_noise",
            "N",
        ),
        OptionDeclaration(
            "--force-gain-error",
            "Maximum relative gain error of a foot force sensor",
            "body.force_gain_error",
            "1",
        ),
        OptionDeclaration(
            "--mass-error",
            "Maximum relative error of a link mass",
            "body.mass_error",
            "1",
        ),
        OptionDeclaration(
            "--com-error",
            "Maximum offset of the torso CoM along each axis",
            "body.com_error",
            "m",
        ),
    ),
)
METHOD = OptionDeclaration(
    "--method",
    "Source of the CoM reference: closed form from the planned state, closed "
    "form from the measured state, or intrinsically stable MPC.",
    "control.method",
    registry=_methods,
)
FEEDBACK = OptionDeclaration(
    "--feedback/--no-feedback",
    "Estimate the state and stabilise the gait, or execute plans in open "
    "loop.  [default: feedback unless --body is ideal]",
    "control.feedback",
    shows_default=False,
    aliases=(" /--open-loop",),
)
CONTROL = OptionGroup(
    "Control",
    (
        METHOD,
        FEEDBACK,
        OptionDeclaration(
            "--learn-turns/--no-learn-turns",
            "Learn from the gyro which fraction of a commanded turn is "
            "achieved, and scale later turns to compensate.",
            "control.learn_turns",
        ),
        OptionDeclaration(
            "--mpc-steps",
            "MPC horizon, in footsteps",
            "control.mpc.steps",
            "steps",
            kind=click.INT,
        ),
        OptionDeclaration(
            "--mpc-samples",
            "MPC samples per footstep",
            "control.mpc.samples",
            "1",
            kind=click.INT,
        ),
        OptionDeclaration(
            "--mpc-tail",
            "Assumed ZMP motion beyond the MPC horizon.",
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
            "Coefficient of friction between soles and floor",
            "physics.friction",
            "1",
        ),
        OptionDeclaration(
            "--unevenness",
            "Maximum height of floor bumps",
            "physics.unevenness",
            "m",
        ),
        OptionDeclaration(
            "--slope", "Slope of the floor", "physics.slope", "rad"
        ),
        OptionDeclaration(
            "--slope-direction",
            "Direction of steepest descent",
            "physics.slope_direction",
            "rad",
        ),
        OptionDeclaration(
            "--time-step",
            "Integration step of the physics",
            "physics.time_step",
            "s",
        ),
        OptionDeclaration(
            "--tick",
            "Control period {unit}; an integer multiple of --time-step.",
            "physics.tick",
            "s",
        ),
    ),
)
