"""Options of how a robot walks, and of where it walks to."""

from typing import TYPE_CHECKING, get_args, get_type_hints

import click

from .declaration import OptionDeclaration, OptionGroup
from .push_type import PUSHES

if TYPE_CHECKING:
    from ...planning import GaitSettings


def _gaits() -> "dict[str, GaitSettings]":
    from ...planning import PRESETS

    return PRESETS


def _profiles() -> tuple[str, ...]:
    from ...planning import GaitSettings

    return get_args(get_type_hints(GaitSettings)["zmp_profile"])


def _swings() -> tuple[str, ...]:
    from ...planning import GaitSettings

    return get_args(get_type_hints(GaitSettings)["swing_profile"])


PRESET = OptionDeclaration(
    "--gait",
    "Gait: the paper's, its durations as printed, or a fast one, which is "
    "stabilised unless it is said not to be; other options of the gait "
    "change it.",
    "gait",
    registry=_gaits,
    more_names=("--preset",),
)
HORIZON = OptionDeclaration(
    "--horizon",
    "Footsteps of a maneuver that is planned anew at each step",
    "gait.horizon",
    "steps",
    kind=click.INT,
)
GAIT = OptionGroup(
    "Gait",
    (
        PRESET,
        OptionDeclaration(
            "--speed", "Driving speed of the template", "gait.speed", "m/s"
        ),
        OptionDeclaration("--gain", "Steering gain k", "gait.gain", "1/s"),
        OptionDeclaration(
            "--stride", "Step size along the path", "gait.stride", "m"
        ),
        OptionDeclaration(
            "--outer-stride",
            "Longest way {unit} of the outer foot in a step of a turn; "
            "sharper turns shorten the stride.",
            "gait.outer_stride",
            "m",
            words={"none": None},
        ),
        OptionDeclaration(
            "--foot-spacing",
            "Distance {unit} between the feet, side by side.",
            "gait.foot_spacing",
            "m",
        ),
        OptionDeclaration(
            "--step-height",
            "Greatest height {unit} of a swinging foot.",
            "gait.step_height",
            "m",
        ),
        OptionDeclaration(
            "--single-support",
            "Time on one foot",
            "gait.single_support",
            "s",
        ),
        OptionDeclaration(
            "--double-support",
            "Time on both feet, between two steps",
            "gait.double_support",
            "s",
        ),
        OptionDeclaration(
            "--start-support",
            "Time on both feet before the first step",
            "gait.start_support",
            "s",
        ),
        OptionDeclaration(
            "--com-height",
            "Height {unit} of the CoM over the floor.",
            "gait.com_height",
            "m",
        ),
        OptionDeclaration(
            "--zmp-forward",
            "How far {unit} the ZMP lies ahead of the ankle.",
            "gait.zmp_forward",
            "m",
        ),
        OptionDeclaration(
            "--profile",
            "ZMP between the feet in double support.",
            "gait.zmp_profile",
            registry=_profiles,
            more_names=("--zmp-profile",),
        ),
        OptionDeclaration(
            "--swing-profile",
            "Way of the swing foot over time.",
            "gait.swing_profile",
            registry=_swings,
        ),
        OptionDeclaration(
            "--swing-reaction",
            "Shift {unit} of the ZMP by an acceleration of the swing foot.",
            "gait.swing_reaction",
            "s^2",
        ),
        HORIZON,
    ),
)
BEARING = OptionDeclaration(
    "--bearing",
    "Desired heading {unit} in the frame of the support foot; 0 goes "
    "straight.",
    "bearing",
    "rad",
)
WALK = OptionGroup(
    "Walk",
    (
        BEARING,
        OptionDeclaration(
            "--backward/--forward", "Where the robot walks.", "backward"
        ),
        PUSHES,
    ),
)
