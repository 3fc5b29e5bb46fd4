"""``stepaside robot``: show, describe, check or tune a robot."""

from typing import Any

import click

from .main import LazyGroup

COMMANDS = {
    "show": "Show a robot; the word may be left out before its name.",
    "init": "Derive a description from a published model.",
    "check": "Check whether a robot can play.",
    "tune": "Search for the steadiest gait and store it.",
    "legs": "Inspect or measure a learned walking policy.",
}


@click.group(
    "robot",
    cls=LazyGroup,
    lazy=COMMANDS,
    module="robot_{}",
    default="show",
)
def robot(**_: Any) -> None:
    """Show a robot, or describe a new one from its published model.

    A robot is a built-in one (nao), or a folder with a robot.toml and a
    model.
    """
