"""Functions called after each tick of a match."""

from collections.abc import Callable
from typing import Any

from stepaside.games.match import Match
from stepaside.games.outcome import Outcome


class TickObserver:
    """Observer of a match that calls a function after each tick."""

    def __init__(self, call: Callable[[Any], None]) -> None:
        """Call a function with the match."""
        self._call = call

    def before(self, match: Match) -> None:
        """Do nothing."""

    def acted(self, match: Match) -> None:
        """Call the function."""
        self._call(match)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Do nothing."""


def observe_ticks(match: Match, call: Callable[[Any], None]) -> TickObserver:
    """Call a function after each tick from now on."""
    made = TickObserver(call)
    match.observers = (*match.observers, made)
    return made


def stop_observing(match: Match, observer: TickObserver) -> None:
    """Stop calling the function of an observer."""
    match.observers = tuple(o for o in match.observers if o is not observer)
