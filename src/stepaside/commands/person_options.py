"""Options of a person who comes instead of a robot."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from .options import NumberType

if TYPE_CHECKING:
    from ..games.settings import DuelSettings

F = TypeVar("F", bound=Callable[..., Any])
PREFIX = "person_"


def person_options(command: F) -> F:
    """Add ``--pursuer`` and how a person walks."""
    for option in (
        click.option(
            "--person-miss",
            type=float,
            help="How far beside the evader a straight walk aims [m].",
        ),
        click.option(
            "--person-gain", type=NumberType("1/s"), help="Steering; 0.2."
        ),
        click.option(
            "--person-speed", type=NumberType("m/s"), help="0.15 m/s."
        ),
        click.option(
            "--person-path",
            help="steer (default), straight, or a CSV file of time,x,y.",
        ),
        click.option(
            "--pursuer",
            type=click.Choice(["robot", "person"]),
            help="Who comes: another robot (default), or a person.",
        ),
    ):
        command = option(command)
    return command


def with_person(
    settings: "DuelSettings", given: dict[str, Any]
) -> "DuelSettings":
    """Settings with the person that options ask for.

    Args:
        settings: Of the duel.
        given: Options; those of the person are taken out.
    """
    from dataclasses import replace

    person = {
        key.removeprefix(PREFIX): given.pop(key)
        for key in list(given)
        if key.startswith(PREFIX)
    }
    if not person:
        return settings
    return replace(settings, person=replace(settings.person, **person))
