"""Forecast of a duel against a person, by the game of its templates."""

from ..robots.description import load_robot
from ..strategies.registry import OBJECT
from .floor_games import floor_of, play_floor
from .game import GameRules
from .game_settings import GameSettings
from .player_settings import EVADER, PURSUER

SHORT = 0.01  # between decisions of a person, in [s]


def approach_of_person(settings: GameSettings) -> float | None:
    """Return the closest approach of a person to the evader's template [m].

    None where the template is no model of the game.
    """
    own, velocities = settings.evader, None
    if own.strategy.startswith(OBJECT):
        return None
    if own.legs.network:
        from ..locomotion.policy.policy_legs import load_legs

        robot, tick = load_robot(own.robot), settings.physics.tick
        velocities = load_legs(own.legs, robot, tick=tick).velocities
    elif not settings.is_of_the_paper:
        return None
    world = floor_of(settings, period=SHORT, velocities=velocities)
    rules = GameRules(settings.duration, identities=settings.identities)
    game, _ = play_floor(world, rules)
    return game.closest[EVADER, PURSUER]
