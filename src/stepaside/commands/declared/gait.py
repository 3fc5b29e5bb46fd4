"""Options of how a robot walks, and of where it walks to."""

from typing import TYPE_CHECKING, get_args, get_type_hints

import click

from .option import Declaration, Group
from .push import PushType

if TYPE_CHECKING:
    from ...planning import GaitSettings


def _gaits() -> "dict[str, GaitSettings]":
    from ...planning import PRESETS

    return PRESETS


def _profiles() -> tuple[str, ...]:
    from ...planning import GaitSettings

    return get_args(get_type_hints(GaitSettings)["zmp_profile"])


PRESET = Declaration(
    "--preset",
    "Gait: the NAO that walks, or the durations as printed; other options of "
    "the gait change it.",
    "gait",
    registry=_gaits,
)
HORIZON = Declaration(
    "--horizon",
    "Footsteps of a maneuver that is planned anew at each step",
    "gait.horizon",
    "steps",
    kind=click.INT,
)
GAIT = Group(
    "Gait",
    (
        PRESET,
        Declaration(
            "--speed", "Driving speed of the template", "gait.speed", "m/s"
        ),
        Declaration("--gain", "Steering gain k", "gait.gain", "1/s"),
        Declaration(
            "--stride", "Step size along the path", "gait.stride", "m"
        ),
        Declaration(
            "--foot-spacing",
            "Distance {unit} between the feet, side by side.",
            "gait.foot_spacing",
            "m",
        ),
        Declaration(
            "--step-height",
            "Greatest height {unit} of a swinging foot.",
            "gait.step_height",
            "m",
        ),
        Declaration(
            "--single-support",
            "Time on one foot",
            "gait.single_support",
            "s",
        ),
        Declaration(
            "--double-support",
            "Time on both feet, between two steps",
            "gait.double_support",
            "s",
        ),
        Declaration(
            "--start-support",
            "Time on both feet before the first step",
            "gait.start_support",
            "s",
        ),
        Declaration(
            "--com-height",
            "Height {unit} of the CoM over the floor.",
            "gait.com_height",
            "m",
        ),
        Declaration(
            "--zmp-forward",
            "How far {unit} the ZMP lies ahead of the ankle.",
            "gait.zmp_forward",
            "m",
        ),
        Declaration(
            "--profile",
            "ZMP between the feet in double support.",
            "gait.zmp_profile",
            registry=_profiles,
            more_names=("--zmp-profile",),
        ),
        HORIZON,
    ),
)
BEARING = Declaration(
    "--bearing",
    "Desired heading {unit} in the frame of the support foot; 0 goes "
    "straight.",
    "bearing",
    "rad",
)
PUSHES = Declaration(
    "--push",
    "Push the torso, any number of times: 1.2@5:90deg is 1.2 N s at "
    "5 s to the left.",
    "pushes",
    kind=PushType(),
    extra={"multiple": True},
)
WALK = Group(
    "Walk",
    (
        BEARING,
        Declaration(
            "--backward/--forward", "Where the robot walks.", "backward"
        ),
        PUSHES,
    ),
)
