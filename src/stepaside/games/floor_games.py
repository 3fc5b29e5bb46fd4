"""Games on the floor: of two strategies, and of the settings of a game."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import pi
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from ..arena import NO_OBSTACLES, OPEN_FLOOR, ObstacleSet, Room
from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import ConfigurationError, StrategyError
from ..core.player_identity import PlayerIdentity, Role
from ..core.poses import Array, Pose, wrap_angles
from ..planning import GaitSettings
from ..sim.crowd_motion import RADIUS, CrowdMotion
from ..sim.person_motion import PersonMotion, Place
from ..strategies.evasion import Evasion
from ..strategies.goal_walk import GoalWalk
from ..strategies.knowledge import Limits, limits_of
from ..strategies.pursuit import Pursuit
from ..strategies.registry import load_strategy
from ..strategies.shield import shielded
from ..strategies.strategy import Strategy
from ..strategies.strategy_game import StepGame
from ..strategies.velocity_set import VelocitySet
from ..theory.unicycle.unicycle_game import Game, RelativeStart
from .floor_world import (
    PARTS,
    PERIOD,
    FloorAgent,
    FloorMotion,
    FloorPerson,
    FloorPoint,
    FloorRecorder,
    FloorReplay,
    FloorWalk,
    FloorWorld,
)
from .game import GameInPlay, GameRules, play
from .game_settings import GameSettings
from .outcome import Outcome
from .player_settings import PlayerSettings

UNBOUNDED = 1e9  # safety radius of a game without safety area, in [m]
MARGIN = 0.06  # of bodies and of their sway, in [m]
ORIGIN = Pose(0.0, 0.0, 0.0)
COMFORT = 0.35  # beyond contact, that a walk to a goal keeps free, in [m]
PAIR = {
    name: PlayerIdentity(name, Role(name), name)
    for name in ("pursuer", "evader")
}
"""Identities of pursuer and evader."""


class StrategyTrack(NamedTuple):
    """Recorded game of two strategies.

    Attributes:
        outcome: Outcome of the game.
        times: Times of the poses, in [s]. Shape (n,).
        pursuer: Poses (x [m], y [m], theta [rad]), from the start on.
            Shape (n, 3).
        evader: Poses of the evader, likewise.
        clearances: Clearances of the evader's centre, in [m]. Shape (n,).
        decision: Mean processor time of a decision of the evader, without
            the first one, which loads code, in [s].
        longest_decision: Longest time of a decision, likewise.
    """

    outcome: Outcome
    times: Array
    pursuer: Array
    evader: Array
    clearances: Array
    decision: float
    longest_decision: float

    @property
    def captured(self) -> bool:
        """Whether the distance fell to the capture distance."""
        return self.outcome is Outcome.CAPTURED

    @property
    def bearings(self) -> Array:
        """Bearings of the pursuer from the evader, in [rad]. Shape (n,)."""
        dx, dy, _ = (self.pursuer - self.evader).T
        return wrap_angles(np.arctan2(dy, dx) - self.evader[:, 2])

    @property
    def distances(self) -> Array:
        """Distance between the two, in [m]. Shape (n,)."""
        apart = self.evader - self.pursuer
        found: Array = np.hypot(apart[:, 0], apart[:, 1])
        return found

    @property
    def closest_distance(self) -> float:
        """Least recorded distance, in [m]."""
        return float(self.distances.min())


def play_strategies(
    pursuer: Strategy,
    evader: Strategy,
    starts: tuple[Pose, Pose],
    *,
    room: Room = OPEN_FLOOR,
    game: StepGame | None = None,
) -> StrategyTrack:
    """Play a game of two strategies without physics.

    Args:
        pursuer: Strategy of the pursuer.
        evader: Strategy of the evader.
        starts: Initial poses of pursuer and evader in the room.
        room: Room; the evader knows all obstacles, and so does a pursuer
            that they stop.
        game: Rules; by default those of :class:`StepGame`.

    Raises:
        StrategyError: If a strategy fails.
    """
    game = game or StepGame()
    world = floor_of_two(game, (pursuer, evader), starts, room)
    recorder = FloorRecorder(world)
    played = GameInPlay(world, rules_of_two(game), (recorder,))
    play(played)
    return track_of(played, recorder, room)


def play_unicycles(
    game: Game,
    start: RelativeStart,
    names: tuple[str, str],
    times: tuple[float, float],
    capture: float,
) -> StrategyTrack:
    """Play a game of unicycles with named strategies.

    The paper's evader evades from the begin. ``times`` are duration and
    decision period, in [s]; the capture distance, in [m], ends the game.
    """
    evasion = Evasion(
        game.angle,
        game.saturated,
        safety_radius=UNBOUNDED,
        side_hysteresis=game.hysteresis,
    )
    pursuer, evader = (load_strategy(name, evasion) for name in names)
    rules = StepGame.of_unicycles(
        game.pursuer, game.evader, times[1], times[0], capture
    )
    return play_strategies(pursuer, evader, start.poses(), game=rules)


def track_of(
    game: GameInPlay, recorder: FloorRecorder, room: Room = OPEN_FLOOR
) -> StrategyTrack:
    """Return the record of a finished game, or raise what broke it off."""
    assert game.ended is not None
    if game.ended.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    if game.ended.outcome is Outcome.FAILED:
        raise StrategyError(game.message)
    poses, evades = recorder.poses(), recorder.world.motions["evader"]
    times = evades.decision_times if isinstance(evades, FloorWalk) else []
    return StrategyTrack(
        game.ended.outcome,
        recorder.times,
        poses["pursuer"],
        poses["evader"],
        room.clearance(poses["evader"][:, :2]),
        float(np.mean(times[1:] or times or [0.0])),
        max(times[1:], default=0.0),
    )


def floor_of_two(
    game: StepGame,
    strategies: tuple[Strategy, Strategy],
    starts: tuple[Pose, Pose],
    room: Room = OPEN_FLOOR,
) -> FloorWorld:
    """Return the world of a game of pursuer and evader."""
    solids = room.solid_set
    # A pursuer that obstacles do not stop plans no detours.
    stops = solids if game.solid_pursuer else NO_OBSTACLES
    motions = {
        name: FloorWalk(
            FloorAgent(
                strategy, limits, own, list(PAIR.values()), obstacles=known
            ),
            start,
            parts=game.decisions,
            largest_turn=game.largest_turn,
            walls=stops if name == "pursuer" else NO_OBSTACLES,
            radius=game.body_radius,
        )
        for (name, own), strategy, limits, start, known in zip(
            PAIR.items(),
            strategies,
            game.limits,
            starts,
            (stops, solids),
            strict=True,
        )
    }
    return FloorWorld(motions, solids, ["evader"])


def rules_of_two(game: StepGame) -> GameRules:
    """Return what ends a game of pursuer and evader."""
    return GameRules(game.whole_duration, game.capture, PAIR)


def play_template(
    motion: Callable[[Pose, Place], PersonMotion],
    start: Pose,
    evader: Pose,
    strategy: Strategy,
    gait: GaitSettings,
    *,
    duration: float,
    velocities: VelocitySet | None = None,
    step: float = 0.01,
) -> StrategyTrack:
    """Play the template of an evader against a prescribed motion.

    The evader decides once per footstep; while it stands it decides at any
    time, and moves after its first double support. One on learned legs is
    the point that stands for them.

    Args:
        motion: Returns the motion of the pursuer from its initial pose and
            the evader's position.
        start: Initial pose of the pursuer in the world.
        evader: That of the evader.
        strategy: Strategy of the evader.
        gait: Its gait.
        duration: Duration of the game, in [s].
        velocities: Velocities of learned legs; None for a unicycle.
        step: Step of the integration, in [s].
    """
    limits, everyone = limits_of(gait, velocities), list(PAIR.values())
    agent = FloorAgent(strategy, limits, PAIR["evader"], everyone)
    own: FloorMotion
    if velocities is not None:
        own = FloorPoint(agent, evader, gait, step)
    else:
        own = FloorWalk(agent, evader, delay=gait.start_support, alert=step)
    walk = motion(start, (evader.x, evader.y))
    person = FloorPerson("pursuer", walk, {}, "evader", step)
    world = FloorWorld({"pursuer": person, "evader": own})
    recorder = FloorRecorder(world, step)
    game = GameInPlay(world, GameRules(duration), (recorder,))
    play(game)
    return track_of(game, recorder)


def floor_of(
    settings: GameSettings,
    strategies: Mapping[str, Strategy] = MappingProxyType({}),
) -> FloorWorld:
    """Return the world of a game at level "unicycle" or "steps".

    Strategies as objects replace those of the settings, by name of the
    player. Obstacles stop pursuers; any other robot that touches one ends
    the game.
    """
    return FloorWorld(
        {
            own.name: motion_of(settings, own, given=strategies.get(own.name))
            for own in settings.players
        },
        _solids(settings),
        [p.name for p in settings.players if p.role != Role.PURSUER],
    )


def _solids(settings: GameSettings) -> ObstacleSet:
    return (settings.room or OPEN_FLOOR).solid_set


def rules_of(settings: GameSettings) -> GameRules:
    """Return what ends a game of these settings.

    In physics a game goes on after a capture: contact ends it.
    """
    goals = {p.name: p.goal for p in settings.players if p.goal and p.decides}
    capture = 0.0 if settings.level == "physics" else CAPTURE_DISTANCE
    return GameRules(settings.duration, capture, settings.identities, goals)


def motion_of(
    settings: GameSettings,
    own: PlayerSettings,
    period: float = PERIOD,
    given: Strategy | None = None,
) -> FloorMotion:
    """Return the motion of a player that physics does not move.

    A person on a path decides after each period, in [s]; a strategy that is
    given replaces that of the settings.
    """
    pose, solids = own.pose, _solids(settings)
    physics = settings.level == "physics"
    assert pose is not None
    if own.decides:
        return FloorWalk(
            agent_of(settings, own, given),
            pose,
            parts=PARTS.get(settings.level, 1),
            delay=own.gait.start_support if physics else 0.0,
            walls=solids if own.role == Role.PURSUER else NO_OBSTACLES,
            radius=own.radius + MARGIN,
        )
    if own.body == "run":
        return FloorReplay(own.run, own.run_player)
    if not own.goal:
        walk, target = walk_on_path(settings, own), _target_of(settings, own)
        return FloorPerson(own.name, walk, {}, target, period)
    people = settings.people_around(own)
    bodies = {
        p.name: (p.name in people, p.radius, people.get(p.name, False))
        for p in settings.players
    }
    crowd = CrowdMotion(own.crowd, pose, (own.goal[0], own.goal[1]), solids)
    return FloorPerson(own.name, crowd, bodies)


def strategy_of(
    player: PlayerSettings,
    map_in_world: Pose = ORIGIN,
    given: Strategy | None = None,
) -> Strategy:
    """Return the strategy of a player, or a given one, with its shield.

    It knows places in a map, whose pose in the world is given.
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


def agent_of(
    settings: GameSettings,
    own: PlayerSettings,
    given: Strategy | None = None,
) -> FloorAgent:
    """Return the strategy of a template, which knows the room."""
    gait, knows = own.gait, settings.knows_room
    return FloorAgent(
        strategy_of(own, given=given),
        Limits(gait.speed, gait.gain, gait.stride, gait.step_duration),
        own.identity,
        list(settings.identities.values()),
        target=own.target,
        obstacles=_solids(settings) if knows else NO_OBSTACLES,
    )


def walk_on_path(settings: GameSettings, own: PlayerSettings) -> PersonMotion:
    """Return the walk of a person without a goal, at its begin."""
    pose = own.pose
    aim = settings.player(_target_of(settings, own)).pose
    assert pose is not None and aim is not None
    course = pose.theta + (pi if own.person.backward else 0.0)
    start = Pose(pose.x, pose.y, course)
    return PersonMotion(own.person, start, aim[:2], _solids(settings))


def _target_of(settings: GameSettings, own: PlayerSettings) -> str:
    """Return the name of the player that a person without a goal walks to."""
    others = [p for p in settings.players if p.name != own.name]
    if own.target:
        return own.target
    opposing = [p for p in others if own.identity.opposes(p.identity)]
    deciding = [p for p in others if p.decides]
    for candidates in (opposing, deciding, others):
        if candidates:
            return candidates[0].name
    raise ConfigurationError(
        f"{own.name}: a person without a goal needs another player, got none"
    )
