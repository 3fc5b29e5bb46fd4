"""Options that say what body walks, on what floor, with what feedback."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar, cast

import click

from .options import ANGLE, NumberType

if TYPE_CHECKING:
    from ..control.balance.settings import ControlSettings, Method
    from ..world.body_settings import BodySettings
    from ..world.settings import PhysicsSettings

F = TypeVar("F", bound=Callable[..., Any])
FLOORS = ("friction", "unevenness", "slope", "slope_direction")


def body_options(command: F) -> F:
    """Add ``--body``, ``--method`` and ``--feedback``."""
    for option in (
        click.option(
            "--feedback/--open-loop",
            "feedback",
            default=None,
            help="Estimate the state and stabilise the walk, or replay the "
            "plans; feedback for all bodies but the ideal one by default.",
        ),
        click.option(
            "--method",
            type=click.Choice(["closed-form", "measured", "mpc"]),
            help="Where the CoM comes from: the planned state, the measured "
            "one, or intrinsically stable MPC.",
        ),
        click.option(
            "--body",
            type=click.Choice(["ideal", "delayed", "hardware"]),
            help="How far the body is from an ideal one.",
        ),
    ):
        command = option(command)
    return command


def floor_options(command: F) -> F:
    """Add the options of the floor."""
    for option in (
        click.option(
            "--friction",
            type=NumberType("1"),
            help="Friction of the soles [1]; 0.8 by default.",
        ),
        click.option(
            "--unevenness",
            type=NumberType("m", allow_zero=True),
            help="Height of the floor's bumps [m].",
        ),
        click.option("--slope", type=ANGLE, help="Of the floor."),
        click.option(
            "--slope-direction", type=ANGLE, help="Where it descends to."
        ),
    ):
        command = option(command)
    return command


def body_settings(
    body: str | None,
    method: str | None,
    feedback: bool | None,
    settings: "tuple[BodySettings, ControlSettings] | None" = None,
) -> "tuple[BodySettings, ControlSettings]":
    """Body and control that the options ask for.

    Args:
        body: Name of a preset.
        method: Where the CoM of a maneuver begins.
        feedback: Whether to stabilise; with a body other than the ideal
            one, or a measured state, yes by default.
        settings: What holds for options that were not given.

    Raises:
        ConfigurationError: If method and feedback do not go together.
    """
    from ..control.balance.settings import ControlSettings
    from ..world.body_settings import BODIES

    if settings is None:
        settings = BODIES["ideal"], ControlSettings()
    built, control = settings
    if body is not None:
        built = BODIES[body]
    if feedback is None and (method or body) is not None:
        feedback = body not in (None, "ideal") or (
            method not in (None, "closed-form")
        )
        feedback = feedback or (body is None and control.feedback)
    if feedback is not None:
        if method is None:
            method = "measured" if feedback else "closed-form"
        control = replace(
            control,
            method=cast("Method", method),
            feedback=feedback,
        )
    return built, control


def floor_settings(
    options: dict[str, Any], physics: "PhysicsSettings | None" = None
) -> "PhysicsSettings":
    """Take the floor's options out of others.

    Args:
        options: All options; those of the floor are removed.
        physics: What holds for options that were not given.
    """
    from ..world.settings import PhysicsSettings

    given = {name: options.pop(name, None) for name in FLOORS}
    changes = {name: v for name, v in given.items() if v is not None}
    return replace(physics or PhysicsSettings(), **changes)
