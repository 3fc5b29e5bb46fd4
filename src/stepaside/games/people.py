"""Players of a game that physics does not move: people, and templates."""

from collections.abc import Callable
from math import pi
from typing import Any, Protocol

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..locomotion.locomotion import MotionRequest, template_velocity
from ..planning import GaitSettings
from ..sim.crowd_motion import CrowdMotion, Neighbour
from ..sim.person_body import MarkerBody, PersonBody
from ..sim.person_motion import PersonMotion
from ..sim.person_settings import RADIUS
from ..sim.world import World
from ..strategies.knowledge import Knowledge
from ..strategies.velocity_set import STILL, respond
from .floor_world import AT_ONCE, PERIOD, FloorAgent, FloorMotion, Seen
from .game import GameInPlay, Outcome
from .game_settings import GameSettings
from .player_settings import PlayerSettings
from .players import Player
from .run import Run
from .summary import CrowdSummary
from .trajectory import distance_between

INTRUSIONS = (0.45, 1.2)  # of crowd navigation: intimate and personal, [m]


class MovingPerson(Protocol):
    """Motion of a person, integrated step by step."""

    pose: Pose  # present

    def advance(self, time: float, duration: float, others: Any) -> None:
        """Walk on up to a time, in [s], as others are seen."""


class FloorPerson(FloorMotion):
    """Person who walks among others, whom a function finds in what is seen."""

    def __init__(
        self,
        motion: MovingPerson,
        others: Callable[[Seen], Any],
        period: float = PERIOD,
    ) -> None:
        """Begin a walk that decides in each period, in [s]."""
        self.motion, self.pose = motion, motion.pose
        self._others, self._period, self._now = others, period, 0.0

    def decide(self, now: float, seen: Seen) -> None:
        """Walk on for one period."""
        self._now, self.due = now, now + self._period
        self.motion.advance(self.due, self._period, self._others(seen))

    def pose_at(self, time: float) -> Pose:
        """Return the pose at a time before the next decision, in [s]."""
        (x, y, _), ahead = self.pose, self.motion.pose
        if time <= self._now:
            return self.pose
        share = min(1.0, (time - self._now) / (self.due - self._now))
        return Pose(
            x + share * (ahead.x - x), y + share * (ahead.y - y), ahead.theta
        )

    def advance(self, until: float) -> None:
        """Move to a time, in [s]."""
        super().advance(until)
        self._now = until


def walk_of(
    settings: GameSettings, own: PlayerSettings, period: float
) -> FloorPerson:
    """Return the walk of a person, who decides in each period, in [s]."""
    if not own.goal:
        target = _target_of(settings, own)
        walk = walk_on_path(settings, own)
        return FloorPerson(walk, lambda seen: seen[target][:2], period)
    bodies = {}  # whether it is a person, radius [m], whether in its group
    for p in settings.players:
        person, same = p.body == "person", p.team == own.team != ""
        bodies[p.name] = person, p.radius, person and same
    del bodies[own.name]

    def neighbours(seen: Seen) -> list[Neighbour]:
        return [
            Neighbour(seen[name].x, seen[name].y, *body)
            for name, body in bodies.items()
        ]

    pose, (x, y) = own.pose, own.goal
    assert pose is not None
    crowd = CrowdMotion(own.crowd, pose, (x, y), settings.solids)
    return FloorPerson(crowd, neighbours)


def walk_on_path(settings: GameSettings, own: PlayerSettings) -> PersonMotion:
    """Return the walk of a person without a goal, at its begin."""
    pose = own.pose
    aim = settings.player(_target_of(settings, own)).pose
    assert pose is not None and aim is not None
    course = pose.theta + (pi if own.person.backward else 0.0)
    start = Pose(pose.x, pose.y, course)
    return PersonMotion(own.person, start, aim[:2], settings.solids)


def _target_of(settings: GameSettings, own: PlayerSettings) -> str:
    """Return the name of the player that a person without a goal walks to."""
    others = [p for p in settings.players if p.name != own.name]
    if own.target:
        return own.target
    opposing = [p for p in others if own.identity.opposes(p.identity)]
    for each in (*opposing, *(p for p in others if p.decides), *others):
        return each.name
    raise ConfigurationError(
        f"{own.name}: a person without a goal needs another player, got none"
    )


class FloorPoint(FloorMotion):
    """Point that stands for learned legs: it walks in any direction.

    Its velocity follows the commands with the lags of the legs.
    """

    agent: FloorAgent

    def __init__(
        self, agent: FloorAgent, pose: Pose, gait: GaitSettings, step: float
    ) -> None:
        """Begin standing, to be integrated in steps, in [s]."""
        assert agent.limits.velocities is not None
        self.agent, self._legs = agent, agent.limits.velocities
        self.pose = pose
        self._gait, self._step, self._decides_at = gait, step, 0.0
        self._command = self._actual = STILL

    def decide(self, now: float, seen: Seen) -> None:
        """Decide if it is time to, and walk on for one step."""
        self.due = now + self._step
        if now >= self._decides_at - AT_ONCE:
            self._begin(now, seen)
        self._actual = respond(
            self._actual, self._command, self._legs.lags, self._step
        )

    def _begin(self, now: float, seen: Seen) -> None:
        """Choose the command of the legs."""
        from ..locomotion.policy.policy_legs import decision_interval

        moving = self._command != STILL
        known = self.agent.look(now, seen, moving=moving)
        assert known is not None
        intent, strategy = self.agent.evaluate(known), self.agent.strategy
        request = MotionRequest(intent, strategy.direction, strategy.saturated)
        self._command = self._legs.nearest(
            template_velocity(request, self._gait)
        )
        if self._command != STILL:
            self._decides_at = now + decision_interval(intent, self._gait)

    def pose_at(self, time: float) -> Pose:
        """Return the pose at a time before the next sample, in [s]."""
        left = self._step - (self.due - time)
        return self.pose.compose(Pose(*(left * rate for rate in self._actual)))


class FloorPlayer(Player):
    """Player that physics does not move.

    A body on the floor shows it and gives its true state. Its motion is that
    of a game without bodies (:mod:`.floor_world`).
    """

    def __init__(
        self,
        world: World,
        own: PlayerSettings,
        motion: FloorMotion,
        seen: Callable[[], Seen],
    ) -> None:
        """Combine a motion, its body in a world, and what it sees."""
        self.name, self._motion, self._seen = own.name, motion, seen
        made = PersonBody if own.body == "person" else MarkerBody
        self._body = made(world, own.name, motion.pose)
        self.truth = self._body.truth

    def follow(self, motion: FloorMotion) -> None:
        """Move as another motion from now on."""
        self._motion = motion

    @property
    def is_moving(self) -> bool:
        """Whether it walks."""
        return self._motion.is_walking

    def tick(self) -> None:
        """Advance the motion by one tick."""
        motion = self._motion
        while (seen := self._seen_if_due()) is not None:
            motion.decide(motion.due, seen)
        motion.advance(self._until)
        self._body.move(motion.pose)

    def look(self) -> Knowledge | None:
        """Return the knowledge for a decision in this tick, if one is due."""
        motion, seen = self._motion, self._seen_if_due()
        return None if seen is None else motion.look(motion.due, seen)

    @property
    def _until(self) -> float:
        """End of this tick, in [s]."""
        return self._body.world.time + self._body.world.physics.tick

    def _seen_if_due(self) -> Seen | None:
        """Move to a decision in this tick; return what is seen then."""
        motion = self._motion
        if motion.due >= self._until - AT_ONCE:
            return None
        motion.advance(motion.due)
        return {**self._seen(), self.name: motion.pose}


def crowds_of(run: Run, game: GameInPlay) -> dict[str, CrowdSummary]:
    """Measure the encounter of each robot with people, by name."""
    times = run.times
    people = [run.tracks[name].unicycle for name in run.persons]
    period = float(times[1] - times[0]) if len(times) > 1 else 0.0
    found = {}
    for own in run.settings.players:
        if not own.decides:
            continue
        poses = run.tracks[own.name].unicycle
        apart = np.array([distance_between(poses, each) for each in people])
        if run.settings.level == "physics" and own.body == "robot":
            collisions = int(own.name in game.touched)
        else:
            touching = apart < own.radius + RADIUS
            begins = np.diff(touching.astype(int), axis=1, prepend=0) > 0
            collisions = int(np.count_nonzero(begins))
        nearest = apart.min(axis=0)
        intimate, personal = (
            period * int(np.count_nonzero(nearest < limit))
            for limit in INTRUSIONS
        )
        completed = run.outcome is Outcome.COMPLETED
        reached = own.name in game.goals_at if own.goal else completed
        harmed = collisions or own.name in (*game.touched, *game.fallen)
        found[own.name] = CrowdSummary(
            people=len(people),
            success=reached and not harmed,
            collisions=collisions,
            intimate_s=intimate,
            personal_s=personal,
        )
    return found
