"""Worlds and rules of games on the floor, from the settings of a game."""

from collections.abc import Mapping
from dataclasses import is_dataclass, replace
from types import MappingProxyType

from .. import strategies
from ..arena import NO_OBSTACLES
from ..core.errors import StrategyError
from ..core.player_identity import Role
from ..core.poses import Pose
from ..sim.person_settings import RADIUS
from ..strategies.knowledge import limits_of
from ..strategies.registry import load_strategy
from ..strategies.strategy import BodyStrategy, Strategy
from ..strategies.velocity_set import VelocitySet
from .floor_world import (
    PARTS,
    PERIOD,
    FloorAgent,
    FloorMotion,
    FloorRecorder,
    FloorWalk,
    FloorWorld,
)
from .game import GameInPlay, GameRules, Outcome, play
from .game_settings import GameSettings
from .player_settings import PlayerSettings

MARGIN = 0.06  # of bodies and of their sway, in [m]
ORIGIN = Pose(0.0, 0.0, 0.0)
COMFORT = 0.35  # beyond contact, that a walk to a goal keeps free, in [m]


def play_floor(
    world: FloorWorld, rules: GameRules, period: float = 0.0
) -> tuple[GameInPlay, FloorRecorder]:
    """Play a game on the floor to its end, sampled in each period, in [s].

    By default each decision is sampled. What breaks it off is raised.
    """
    recorder = FloorRecorder(world, period)
    game = GameInPlay(world, rules, (recorder,))
    play(game)
    if game.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    if game.outcome is Outcome.FAILED:
        raise StrategyError(game.message)
    return game, recorder


def floor_of(
    settings: GameSettings,
    strategies: Mapping[str, Strategy] = MappingProxyType({}),
    period: float = PERIOD,
    velocities: VelocitySet | None = None,
) -> FloorWorld:
    """Return the world of a game without bodies.

    At level "physics" it is that of the templates. Strategies as objects
    replace those of the settings, by name of the player. Obstacles stop
    pursuers; any other robot that touches one ends the game. For the others
    see :func:`motion_of`.
    """
    return FloorWorld(
        {
            own.name: motion_of(
                *(settings, own, period, strategies.get(own.name), velocities)
            )
            for own in settings.players
        },
        settings.solids,
        [
            p.name
            for p in settings.players
            if p.role != Role.PURSUER and settings.solids is not NO_OBSTACLES
        ],
    )


def rules_of(settings: GameSettings) -> GameRules:
    """Return what ends a game of these settings.

    In physics a game goes on after a capture: contact ends it.
    """
    goals = {p.name: p.goal for p in settings.players if p.goal and p.decides}
    capture = 0.0 if settings.level == "physics" else settings.capture
    return GameRules(settings.duration, capture, settings.identities, goals)


def motion_of(
    settings: GameSettings,
    own: PlayerSettings,
    period: float = PERIOD,
    given: Strategy | None = None,
    velocities: VelocitySet | None = None,
) -> FloorMotion:
    """Return the motion of a player that physics does not move.

    A person on a path decides after each period, in [s]; so does a template
    that stands in a game in physics. A strategy that is given replaces that
    of the settings. With the velocities of learned legs, a robot is the point
    that stands for them.
    """
    pose, solids = own.pose, settings.solids
    physics = settings.level == "physics"
    assert pose is not None
    if own.decides:
        strategy, radius = strategy_of(settings, own, given), 0.0
        if solids is not NO_OBSTACLES:
            radius = own.radius + MARGIN
            strategy = with_body_radius(strategy, radius)
        agent = FloorAgent(
            strategy,
            limits_of(own.gait, velocities),
            own.identity,
            list(settings.identities.values()),
            target=own.target,
            obstacles=solids if settings.knows_room else NO_OBSTACLES,
        )
        if velocities is not None and own.body == "robot":
            from .people import FloorPoint

            return FloorPoint(agent, pose, own.gait, period)
        return FloorWalk(
            agent,
            pose,
            parts=PARTS.get(settings.level, 1),
            delay=own.gait.start_support if physics else 0.0,
            alert=period if physics else None,
            walls=solids if own.role == Role.PURSUER else NO_OBSTACLES,
            radius=radius,
        )
    from .people import walk_of

    return walk_of(settings, own, period)


def strategy_of(
    settings: GameSettings,
    player: PlayerSettings,
    given: Strategy | None = None,
    map_in_world: Pose = ORIGIN,
) -> Strategy:
    """Return the strategy of a player, or a given one, with its shield.

    It knows places in a map, whose pose in the world is given.
    """
    strategy = load_strategy(given or player.strategy, player.evasion)
    if player.goal and isinstance(strategy, strategies.GoalWalk):
        x, y = player.goal
        goal = map_in_world.inverse().compose(Pose(x, y, 0.0))
        contact = player.radius + RADIUS + MARGIN
        strategy = replace(
            strategy,
            goal=(goal.x, goal.y),
            contact=contact,
            clearance=contact + COMFORT,
            body_radius=player.radius + MARGIN,
        )
    if player.shield.enabled or isinstance(strategy, BodyStrategy):
        from .shields import shielded

        opponents = settings.sensed_opponents(player)
        strategy = shielded(strategy, player, opponents)
    return strategy


def with_body_radius(strategy: Strategy, radius: float) -> Strategy:
    """Return a strategy whose body radius is at least one, in [m].

    One without an attribute ``body_radius`` is returned unchanged.
    """
    if getattr(strategy, "body_radius", radius) < radius:
        if is_dataclass(strategy):
            strategy = replace(strategy, body_radius=radius)
    return strategy
