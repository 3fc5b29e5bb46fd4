"""``stepaside run``: a game file, a walk, unicycles or a room."""

from typing import Any

import click

from .main import LazyGroup

COMMANDS = {
    "game": "Play the game of FILE; the word may be left out.",
    "walk": "Simulate the walk of one humanoid and measure it.",
    "unicycles": "Simulate one game of two unicycles (Sec. II).",
    "room": "Generate a random room, or inspect a room file.",
}


@click.group("run", cls=LazyGroup, lazy=COMMANDS, default="game")
def run(**_: Any) -> None:
    """Play a game FILE, or run a walk, unicycles or a room.

    `stepaside run FILE` plays the game of the players that FILE lists.
    """
