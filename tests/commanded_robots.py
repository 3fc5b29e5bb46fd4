"""Simulated robots of a duel that are commanded by velocities."""

from stepaside.games.game_settings import GameSettings
from stepaside.games.player_settings import PLAYERS
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.robot_player import VelocityWalker


def commanded_robots(
    settings: GameSettings, *, ideal_sight: bool = True
) -> tuple[RecordedGame, list[VelocityWalker]]:
    """Return a duel of two robots that are commanded by velocities."""
    game = RecordedGame(settings, remote=dict.fromkeys(PLAYERS, ideal_sight))
    robots = [
        p for p in game.in_physics.players if isinstance(p, VelocityWalker)
    ]
    assert len(robots) == 2
    return game, robots
