"""``stepaside robot legs``: inspect and measure walking policies."""

from typing import Any

import click

from .main import LazyGroup

COMMANDS = {
    "inspect": "Print the contract of a walking policy.",
    "measure": "Measure the velocities that learned legs deliver.",
}


@click.group("legs", cls=LazyGroup, lazy=COMMANDS, module="legs_{}")
def legs(**_: Any) -> None:
    """Inspect a walking policy, or measure how a robot walks."""
