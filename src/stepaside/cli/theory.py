"""``stepaside theory``: circles, maps, bounds and plans."""

from typing import Any

import click

from .main import LazyGroup

COMMANDS = {
    "circle": "Find all circles of a game and their basins of attraction.",
    "map": "Map the closest approach over initial poses; find the worst.",
    "bound": "Compute the best closest approach any evader can achieve.",
    "plan": "Plan one maneuver: footsteps, ZMP and CoM.",
}


@click.group("theory", cls=LazyGroup, lazy=COMMANDS)
def theory(**_: Any) -> None:
    """Compute what theory says of a game, or plan a maneuver."""
