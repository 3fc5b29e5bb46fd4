"""Games of any number of players without bodies: templates on the floor.

Robots are their template unicycles, which decide at steps or continuously;
people and recorded motions are those of a game in physics. Times are gait
times.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi
from typing import NamedTuple, Protocol

import numpy as np

from ..arena import NO_OBSTACLES
from ..core.errors import ConfigurationError
from ..core.player_identity import PlayerIdentity
from ..core.poses import Array, Pose
from ..core.signal_handling import DeferredInterrupt
from ..planning import GaitSettings
from ..planning.path import UnicycleTrajectory
from ..sim.crowd_motion import CrowdMotion, Neighbour
from ..sim.person_motion import PersonMotion
from ..strategies.knowledge import Intent, Limits
from ..strategies.strategy import Strategy
from ..strategies.template_agent import PlayerState, TemplateAgent
from .duel_circle import time_scale
from .game_settings import GameSettings, PlayerSettings
from .game_strategies import strategy_of
from .recorded_motion import RecordedMotion

PERIOD = 0.02  # between two samples, in [s]
World = dict[str, PlayerState]


class TemplateMotion(Protocol):
    """Motion of a player without a body.

    Attributes:
        pose: Present pose in the world.
    """

    @property
    def pose(self) -> Pose:
        """Present pose in the world."""

    def advance(self, time: float, players: World) -> None:
        """Advance by one sample.

        Args:
            time: Present time, in [s].
            players: States of all players now.
        """


class UnicycleMotion:
    """Template of a robot that decides at steps, or at every sample.

    Attributes:
        pose: Present pose in the world.
    """

    def __init__(
        self,
        agent: TemplateAgent,
        pose: Pose,
        gait: GaitSettings,
        identities: dict[str, PlayerIdentity],
        *,
        steps: bool,
    ) -> None:
        """Begin standing.

        Args:
            agent: Strategy of the player.
            pose: Initial pose in the world.
            gait: Gait of the robot.
            identities: Identities of all players, by name.
            steps: Whether it decides at steps.
        """
        self.pose = pose
        self._agent, self._gait = agent, gait
        self._others = {
            identity.name: identity
            for identity in identities.values()
            if identity.name != agent.identity.name
        }
        self._steps, self._scale = steps, time_scale(gait)
        self._moving = False
        self._due = 0.0  # time of the next decision, in [s]
        self._end = pose  # where it is then
        self._ahead: list[Pose] = []  # at the samples until then

    def advance(self, time: float, players: World) -> None:
        """Advance by one sample, with the decisions that are due in it.

        A step ends at its time, between two samples: what is known then of
        the others is their last sample, carried on at constant velocity.
        """
        until = time + PERIOD
        while self._due < until - 1e-9:
            at = max(self._due, time)
            present = {
                name: _carried(state, at - time)
                for name, state in players.items()
            }
            name = self._agent.identity.name
            present[name] = present[name]._replace(pose=self._end)
            self._begin_step(at, until, self.decide(at, present))
        self.pose = self._ahead.pop(0)

    def decide(self, time: float, players: World) -> Intent | None:
        """Evaluate the strategy; None if there is no other player.

        Args:
            time: Present time, in [s].
            players: States of all players now.
        """
        return self._agent.decide(
            time,
            players[self._agent.identity.name],
            {known: players[name] for name, known in self._others.items()},
            moving=self._moving,
        )

    def _begin_step(
        self, time: float, until: float, intent: Intent | None
    ) -> None:
        """Walk or stand until the next decision.

        Args:
            time: Time of the decision, in [s].
            until: Time of the next sample, in [s].
            intent: Intent; None to stand.
        """
        if intent is None or not intent.walks:
            self._moving = False
            self._due, self._ahead = until, [self._end]
            return
        gait, strategy = self._gait, self._agent.strategy
        begin, duration = time, PERIOD
        if self._steps:
            duration = gait.step_duration / intent.pace
            if not self._moving:
                begin += gait.start_support / intent.pace
        self._moving, self._due = True, begin + duration
        turn = gait.gain * intent.heading * gait.path_interval
        share = min(intent.speed_factor, gait.stride_share(turn))
        path = UnicycleTrajectory(
            intent.heading,
            share * gait.speed,
            gait.gain,
            strategy.direction,
            strategy.saturated,
        )
        samples = int((self._due - until) / PERIOD + 1.0 + 1e-9)
        times = np.append(until + PERIOD * np.arange(samples), self._due)
        along = np.maximum(times - begin, 0.0) * intent.pace * self._scale
        poses = path.poses(along)
        poses[:, :2] = self._end.transform_points(poses[:, :2])
        poses[:, 2] += self._end.theta
        *self._ahead, self._end = (Pose(*pose) for pose in poses.tolist())


def _carried(state: PlayerState, ahead: float) -> PlayerState:
    """Return a state ahead in time, in [s], at constant velocity."""
    (x, y, theta), (u, v) = state
    return PlayerState(Pose(x + ahead * u, y + ahead * v, theta), (u, v))


class FloorBulk(NamedTuple):
    """Body of a player, as a person gives way to it.

    Attributes:
        is_person: Whether it is a person.
        radius: Radius of the body, in [m].
        is_companion: Whether it walks with the person.
    """

    is_person: bool
    radius: float
    is_companion: bool

    def at(self, x: float, y: float) -> Neighbour:
        """Return the body at a place, in [m]."""
        return Neighbour(x, y, *self)


def bodies_of(
    settings: GameSettings, own: PlayerSettings
) -> dict[str, FloorBulk]:
    """Return the bodies of all players, by name, as a person sees them.

    Args:
        settings: Settings of the game.
        own: Settings of the person.
    """
    people = settings.people_around(own)
    return {
        p.name: FloorBulk(
            p.name in people, p.radius, people.get(p.name, False)
        )
        for p in settings.players
    }


class CrowdTemplate:
    """Person who walks to a goal, without a body."""

    def __init__(
        self, name: str, motion: CrowdMotion, bodies: Mapping[str, FloorBulk]
    ) -> None:
        """Take the motion of a person, and the bodies of all players."""
        self._name, self._motion, self._bodies = name, motion, bodies

    @property
    def pose(self) -> Pose:
        """Present pose in the world."""
        return self._motion.pose

    def advance(self, time: float, players: World) -> None:
        """Advance by one sample."""
        others = [
            self._bodies[name].at(*state.pose[:2])
            for name, state in players.items()
            if name != self._name
        ]
        self._motion.advance(time + PERIOD, PERIOD, others)


class PersonTemplate:
    """Person who walks a path relative to another player, without a body."""

    def __init__(self, motion: PersonMotion, target: str) -> None:
        """Take the motion of a person, and the name of its target."""
        self._motion, self._target = motion, target

    @property
    def pose(self) -> Pose:
        """Present pose in the world."""
        return self._motion.pose

    def advance(self, time: float, players: World) -> None:
        """Advance by one sample."""
        target = players[self._target].pose
        self._motion.advance(time + PERIOD, PERIOD, target[:2])


class RecordedTemplate:
    """Player whose motion was recorded."""

    def __init__(self, motion: RecordedMotion) -> None:
        """Take a recorded motion."""
        self._motion = motion
        self.pose = motion.pose_at(0.0)

    def advance(self, time: float, players: World) -> None:
        """Advance by one sample."""
        self.pose = self._motion.pose_at(time + PERIOD)


@dataclass(frozen=True, slots=True, eq=False)
class TemplateRecord:
    """Motion of all players in a game of templates.

    Attributes:
        times: Times of the samples, in [s]. Shape (n,).
        poses: Poses (x, y, heading) in the world of each player, by name,
            in [m] and [rad]. Shapes (n, 3).
        interrupted: Whether the user interrupted it.
    """

    times: Array
    poses: dict[str, Array]
    interrupted: bool


class TemplateMatch:
    """Game of templates, advanced sample by sample.

    Attributes:
        settings: Settings of the game.
        motions: Motion of each player, by name.
        players: Present state of each player, by name.
        samples: Number of samples so far.
    """

    def __init__(self, settings: GameSettings) -> None:
        """Place the players.

        Args:
            settings: Settings with the initial poses filled in.

        Raises:
            StepAsideError: If a strategy is invalid or a recorded run is
                unreadable.
        """
        self.settings = settings
        self.motions = {p.name: _motion(settings, p) for p in settings.players}
        self.players = {
            name: PlayerState(motion.pose)
            for name, motion in self.motions.items()
        }
        self.samples = 0

    @property
    def time(self) -> float:
        """Time, in [s]."""
        return self.samples * PERIOD

    @property
    def all_arrived(self) -> bool:
        """Whether every robot or unicycle with a goal has reached it."""
        going = [p for p in self.settings.players if p.goal and p.decides]
        return bool(going) and all(
            has_arrived(p, self.players[p.name].pose) for p in going
        )

    def advance(self) -> None:
        """Advance all players by one sample.

        Raises:
            StrategyError: If a strategy fails.
        """
        for motion in self.motions.values():
            motion.advance(self.time, self.players)
        self.players = {
            name: _moved(self.players[name].pose, motion.pose)
            for name, motion in self.motions.items()
        }
        self.samples += 1


def play_templates(
    settings: GameSettings,
    report: Callable[[float], None] | None = None,
) -> TemplateRecord:
    """Play a game of templates.

    Args:
        settings: Settings with the initial poses filled in.
        report: Called with the time of the game, in [s], now and then.

    Raises:
        StepAsideError: If a strategy fails or a recorded run is unreadable.
    """
    match = TemplateMatch(settings)
    rows = {name: [motion.pose] for name, motion in match.motions.items()}
    interrupted = False
    try:
        with DeferredInterrupt() as interrupt:
            for k in range(round(settings.duration / PERIOD)):
                interrupt.let_through()
                match.advance()
                for name, motion in match.motions.items():
                    rows[name].append(motion.pose)
                if report is not None and k % 100 == 0:
                    report(k * PERIOD)
                if match.all_arrived:
                    break
    except KeyboardInterrupt:
        interrupted = True
    length = min(len(row) for row in rows.values())
    return TemplateRecord(
        PERIOD * np.arange(length, dtype=np.float64),
        {name: np.array(row[:length]) for name, row in rows.items()},
        interrupted,
    )


def has_arrived(player: PlayerSettings, pose: Pose) -> bool:
    """Return whether a robot or unicycle with a goal has reached it."""
    if not (player.goal and player.decides):
        return False
    return bool(
        np.hypot(pose.x - player.goal[0], pose.y - player.goal[1]) < ARRIVAL
    )


ARRIVAL = 0.3  # distance from a goal at which it is reached, in [m]


def _moved(before: Pose, now: Pose) -> PlayerState:
    """Return the state at a pose, one sample after another pose."""
    return PlayerState(
        now, ((now.x - before.x) / PERIOD, (now.y - before.y) / PERIOD)
    )


def _motion(settings: GameSettings, own: PlayerSettings) -> TemplateMotion:
    """Return the motion of a player."""
    pose = own.pose
    assert pose is not None
    room = settings.room
    obstacles = NO_OBSTACLES if room is None else room.solid_set
    if own.decides:
        return UnicycleMotion(
            agent_of(settings, own),
            pose,
            own.gait,
            settings.identities,
            steps=settings.level == "steps",
        )
    if own.body == "run":
        return RecordedTemplate(RecordedMotion(own.run, own.run_player))
    if own.goal:
        motion = CrowdMotion(own.crowd, pose, own.goal[:2], obstacles)  # type: ignore[arg-type]
        return CrowdTemplate(own.name, motion, bodies_of(settings, own))
    target = target_of_person(settings, own)
    return PersonTemplate(walk_on_path(settings, own), target)


def agent_of(settings: GameSettings, own: PlayerSettings) -> TemplateAgent:
    """Return the strategy of a template, which knows the room.

    Args:
        settings: Settings of the game.
        own: Settings of the player.
    """
    gait, room = own.gait, settings.room
    strategy: Strategy = strategy_of(own, Pose(0.0, 0.0, 0.0))
    return TemplateAgent(
        strategy,
        Limits(gait.speed, gait.gain, gait.stride, gait.step_duration),
        own.identity,
        target=own.target,
        obstacles=room.solid_set
        if room and settings.knows_room
        else NO_OBSTACLES,
    )


def walk_on_path(settings: GameSettings, own: PlayerSettings) -> PersonMotion:
    """Return the walk of a person without a goal, at its begin.

    Args:
        settings: Settings with the initial poses filled in.
        own: Settings of the person.

    Raises:
        ConfigurationError: If there is no other player.
    """
    pose = own.pose
    aim = settings.player(target_of_person(settings, own)).pose
    assert pose is not None and aim is not None
    room = settings.room
    course = pose.theta + (pi if own.person.backward else 0.0)
    return PersonMotion(
        own.person,
        Pose(pose.x, pose.y, course),
        (aim.x, aim.y),
        NO_OBSTACLES if room is None else room.solid_set,
    )


def target_of_person(settings: GameSettings, own: PlayerSettings) -> str:
    """Return the name of the player that a person without a goal walks to.

    Raises:
        ConfigurationError: If there is no other player.
    """
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
