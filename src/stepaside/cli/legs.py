"""``stepaside legs``: convert, inspect and measure walking policies."""

from typing import Any

import click

from .legs_convert import convert
from .legs_inspect import inspect
from .legs_measure import measure


@click.group("legs")
def legs(**_: Any) -> None:
    """Convert or inspect a walking policy, or measure how a robot walks."""


for command in (convert, inspect, measure):
    legs.add_command(command)
