"""The robot of a simulated walk."""

from stepaside.games.recorded_game import RecordedGame
from stepaside.games.walk_settings import WALKER
from stepaside.games.walker import SimulatedPlayer


def walker_of(game: RecordedGame) -> SimulatedPlayer:
    """Return the robot of a walk."""
    walker = game.in_physics.player(WALKER)
    assert isinstance(walker, SimulatedPlayer)
    return walker
