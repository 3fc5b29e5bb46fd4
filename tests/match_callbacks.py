"""Functions called after each tick of a game."""

from collections.abc import Callable
from typing import Any

from stepaside.games.game import GameInPlay, GameObserver


class TickObserver(GameObserver):
    """Observer of a game that calls a function after each tick."""

    def __init__(self, call: Callable[[Any], None]) -> None:
        """Call a function with the game."""
        self._call = call

    def acted(self, game: GameInPlay) -> None:
        """Call the function."""
        self._call(game)


def observe_ticks(
    game: GameInPlay, call: Callable[[Any], None]
) -> TickObserver:
    """Call a function after each tick from now on."""
    made = TickObserver(call)
    game.observers = (*game.observers, made)
    return made


def stop_observing(game: GameInPlay, observer: TickObserver) -> None:
    """Stop calling the function of an observer."""
    game.observers = tuple(o for o in game.observers if o is not observer)
