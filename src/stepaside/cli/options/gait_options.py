"""Options for the gait of a robot and the heading of a walk."""

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
    "Gait preset: the paper's, the paper's with durations as printed, or a "
    "fast one (with feedback unless --open-loop). Other gait options modify "
    "it.",
    "gait",
    registry=_gaits,
    aliases=("--preset",),
)
HORIZON = OptionDeclaration(
    "--horizon",
    "Planning horizon, in footsteps; the maneuver is replanned at each step",
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
            "Maximum displacement of the outer foot in a turn {unit}; sharper "
            "turns shorten the stride.",
            "gait.outer_stride",
            "m",
            words={"none": None},
        ),
        OptionDeclaration(
            "--foot-spacing",
            "Lateral distance between the feet",
            "gait.foot_spacing",
            "m",
        ),
        OptionDeclaration(
            "--step-height",
            "Maximum height of the swing foot",
            "gait.step_height",
            "m",
        ),
        OptionDeclaration(
            "--single-support",
            "Duration of single support",
            "gait.single_support",
            "s",
        ),
        OptionDeclaration(
            "--double-support",
            "Duration of double support between two steps",
            "gait.double_support",
            "s",
        ),
        OptionDeclaration(
            "--start-support",
            "Duration of double support before the first step",
            "gait.start_support",
            "s",
        ),
        OptionDeclaration(
            "--com-height",
            "Height of the CoM above the floor",
            "gait.com_height",
            "m",
        ),
        OptionDeclaration(
            "--zmp-forward",
            "Forward offset of the ZMP from the ankle",
            "gait.zmp_forward",
            "m",
        ),
        OptionDeclaration(
            "--profile",
            "ZMP transfer between the feet in double support.",
            "gait.zmp_profile",
            registry=_profiles,
            aliases=("--zmp-profile",),
        ),
        OptionDeclaration(
            "--swing-profile",
            "Time profile of the swing foot.",
            "gait.swing_profile",
            registry=_swings,
        ),
        OptionDeclaration(
            "--swing-reaction",
            "ZMP shift per acceleration of the swing foot",
            "gait.swing_reaction",
            "s^2",
        ),
        HORIZON,
    ),
)
BEARING = OptionDeclaration(
    "--bearing",
    "Desired heading in the frame of the support foot {unit}; 0 is straight "
    "ahead.",
    "bearing",
    "rad",
)
WALK = OptionGroup(
    "Walk",
    (
        BEARING,
        OptionDeclaration(
            "--backward/--forward", "Walking direction.", "backward"
        ),
        PUSHES,
    ),
)
