"""The robot of a simulated walk."""

from stepaside.games.player_settings import WALKER
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame


def walker_of(game: RecordedGame) -> RobotPlayer:
    """Return the robot of a walk."""
    walker = game.in_physics.player(WALKER)
    assert isinstance(walker, RobotPlayer)
    return walker
