"""Somebody who looks on while a game is played."""

from collections.abc import Callable
from typing import Any

from stepaside.games.match import Match
from stepaside.games.outcome import Outcome


class Onlooker:
    """Calls what it is given when all have acted at a tick."""

    def __init__(self, look: Callable[[Any], None]) -> None:
        """Look with a function of the game."""
        self._look = look

    def before(self, match: Match) -> None:
        """Wait."""

    def acted(self, match: Match) -> None:
        """Look."""
        self._look(match)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Leave."""


def look_on(match: Match, look: Callable[[Any], None]) -> Onlooker:
    """Let somebody look on from now on."""
    made = Onlooker(look)
    match.observers = (*match.observers, made)
    return made


def look_away(match: Match, onlooker: Onlooker) -> None:
    """Let somebody look on no more."""
    match.observers = tuple(o for o in match.observers if o is not onlooker)
