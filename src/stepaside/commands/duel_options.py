"""Options that decide a duel, but for its seed."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from .body_options import (
    body_options,
    body_settings,
    floor_options,
    floor_settings,
)
from .options import ANGLE, METERS, SECONDS, NumberType
from .person_options import person_options, with_person

if TYPE_CHECKING:
    from ..games.settings import DuelSettings

F = TypeVar("F", bound=Callable[..., Any])

_OPTIONS: list[Callable[[Any], Any]] = [
    click.option("--duration", type=SECONDS, help="Simulated time [s]."),
    click.option(
        "--distance", type=METERS, help="Start distance [m]; drawn by default."
    ),
    click.option(
        "--pursuer-offset",
        type=ANGLE,
        help="Heading of the pursuer from the evader; drawn by default.",
    ),
    click.option(
        "--evader-offset",
        type=ANGLE,
        help="Heading of the evader from the pursuer; drawn by default.",
    ),
    click.option(
        "--angle",
        type=ANGLE,
        help="Strategy: 90deg moves aside (default), 0 moves back.",
    ),
    click.option(
        "--saturated", is_flag=True, help="The evader turns by (6), not (4)."
    ),
    click.option(
        "--release-distance",
        type=METERS,
        help="Distance [m] at which evasion ends; never by default.",
    ),
    click.option(
        "--preset",
        type=click.Choice(["nao", "as-printed"]),
        help="Gait: the NAO that walks (default), or durations as printed.",
    ),
    click.option("--bearing-noise", type=ANGLE, help="Standard deviation."),
    click.option(
        "--distance-noise",
        type=NumberType("m", allow_zero=True),
        help="Standard deviation [m].",
    ),
    click.option(
        "--delay", type=NumberType("s", allow_zero=True), help="Of sight [s]."
    ),
    click.option("--rate", type=NumberType("1/s"), help="Of sight [1/s]."),
    body_options,
    floor_options,
    person_options,
    click.option(
        "--sensing",
        type=click.Choice(["ideal", "cameras"]),
        help="Whether they are told where the other is (default) or see it.",
    ),
    click.option(
        "--drop-frames", type=float, help="Share of images that never arrive."
    ),
    click.option(
        "--camera-latency",
        "added_latency",
        type=NumberType("s", allow_zero=True),
        help="Added to that of the cameras [s].",
    ),
    click.option(
        "--clutter", is_flag=True, help="Boxes and a white figure stand about."
    ),
    click.option("--robot", help="Robot, or the folder of its description."),
    click.option(
        "--config",
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        help="Configuration file; options given beside it win.",
    ),
]


def duel_options(command: F) -> F:
    """Add the options that decide a duel, and ``--config``."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def duel_settings(
    config: Path | None, options: dict[str, Any]
) -> "DuelSettings":
    """Settings of a file, overridden by what was given beside it.

    Args:
        config: Configuration; None for the defaults.
        options: Those of :func:`duel_options`, and ``seed`` if there is one.

    Raises:
        StepAsideError: If they ask for what cannot be.
    """
    from dataclasses import replace

    from ..games.configuration import load_configuration
    from ..games.settings import DuelSettings
    from ..planning import PRESETS
    from ..world.camera_settings import CLUTTER, RoomSettings

    settings = DuelSettings() if config is None else load_configuration(config)
    body, control = body_settings(
        options.pop("body"),
        options.pop("method"),
        options.pop("feedback"),
        (settings.body, settings.control),
    )
    physics = floor_settings(options, settings.physics)
    settings = replace(settings, body=body, control=control, physics=physics)
    given = {
        key: value
        for key, value in options.items()
        if value is not None and value is not False
    }
    settings = with_person(settings, given)
    if "preset" in given:
        settings = replace(settings, gait=PRESETS[given.pop("preset")])
    if given.pop("clutter", False):
        settings = replace(settings, room=RoomSettings(things=list(CLUTTER)))
    sections = {
        "start": ("distance", "pursuer_offset", "evader_offset"),
        "strategy": ("angle", "saturated", "release_distance"),
        "sight": ("bearing_noise", "distance_noise", "delay", "rate"),
        "cameras": ("drop_frames", "added_latency"),
    }
    for section, keys in sections.items():
        changes = {key: given.pop(key) for key in keys if key in given}
        if changes:
            changed = replace(getattr(settings, section), **changes)
            settings = replace(settings, **{section: changed})
    return replace(settings, **given)
