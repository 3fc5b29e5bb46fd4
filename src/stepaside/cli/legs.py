"""``stepaside legs``: inspect and measure walking policies."""

from typing import Any

import click

from .legs_inspect import inspect
from .legs_measure import measure


@click.group("legs")
def legs(**_: Any) -> None:
    """Inspect a walking policy, or measure how a robot walks."""


legs.add_command(inspect)
legs.add_command(measure)
