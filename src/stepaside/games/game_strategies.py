"""Strategies of the players of a game."""

from dataclasses import replace

from ..core.poses import Pose
from ..strategies import Strategy, load_strategy
from ..strategies.goal_walk import GoalWalk
from .game_settings import PlayerSettings


def strategy_of(player: PlayerSettings, map_in_world: Pose) -> Strategy:
    """Return the strategy of a player.

    A player with a goal and no strategy walks to the goal.

    Args:
        player: Settings of the player.
        map_in_world: Pose of the frame of its map in the world.
    """
    if player.goal and not player.strategy:
        strategy: Strategy = GoalWalk()
    else:
        strategy = load_strategy(player.played_strategy, player.evasion)
    if isinstance(strategy, GoalWalk) and player.goal:
        x, y = player.goal
        goal = map_in_world.inverse().compose(Pose(x, y, 0.0))
        strategy = replace(strategy, goal=(goal.x, goal.y))
    return strategy
