"""Strategies of the players of a game."""

from dataclasses import replace

from ..core.poses import Pose
from ..sim.crowd_motion import RADIUS
from ..strategies import Strategy, load_strategy
from ..strategies.goal_walk import GoalWalk
from ..strategies.pursuit import Pursuit
from ..strategies.shield import shielded
from .player_settings import PlayerSettings

MARGIN = 0.06  # of bodies and of their sway, in [m]
ORIGIN = Pose(0.0, 0.0, 0.0)
COMFORT = 0.35  # beyond contact, that a walk to a goal keeps free, in [m]


def strategy_of(
    player: PlayerSettings,
    map_in_world: Pose = ORIGIN,
    given: Strategy | None = None,
) -> Strategy:
    """Return the strategy of a player.

    Args:
        player: Settings of the player, with a strategy.
        map_in_world: Pose of the frame of its map in the world.
        given: The strategy as an object, instead of that of the settings.
    """
    strategy = load_strategy(given or player.strategy, player.evasion)
    if isinstance(strategy, GoalWalk) and player.goal:
        x, y = player.goal
        goal = map_in_world.inverse().compose(Pose(x, y, 0.0))
        contact = player.radius + RADIUS + MARGIN
        strategy = replace(
            strategy,
            goal=(goal.x, goal.y),
            contact=contact,
            clearance=contact + COMFORT,
            pursuit=Pursuit(body_radius=player.radius + MARGIN),
        )
    return shielded(strategy, player.shield)
