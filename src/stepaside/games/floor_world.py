"""World without bodies: templates of robots, people and records on a floor.

A robot is its template unicycle, which decides at steps or eight times in a
step, and follows the exact arc of each decision. Times are gait times.
"""

from collections.abc import Collection, Mapping, Sequence
from math import atan2, hypot, inf, pi
from time import thread_time

import numpy as np

from ..arena import NO_OBSTACLES, ObstacleSet
from ..arena.obstacles import stop_at, touches
from ..core.player_identity import PlayerIdentity
from ..core.poses import Array, Pose, wrap_angle
from ..planning import Direction
from ..strategies.decision_maker import (
    DecisionMaker,
    choose_opponent,
    turned,
)
from ..strategies.knowledge import Knowledge, Limits, OtherPlayer
from ..strategies.strategy import Strategy
from .game import GameInPlay, GameObserver, Outcome
from .trajectory import ON_FLOOR, Trajectory

PERIOD = 0.02  # of records, and of the decisions of people, in [s]
AT_ONCE = 1e-9  # times that differ by less are one instant, in [s]
PARTS = {"steps": 1, "unicycle": 8}
"""Decisions of a robot per step, by level."""

Seen = Mapping[str, Pose]
"""Pose of each player in the world, by name."""


class FloorMotion:
    """Motion of a player on the floor; times in [s], poses in the world."""

    pose: Pose  # present
    due = 0.0  # time of its next decision
    agent: "FloorAgent | None" = None  # of one that follows a strategy
    is_walking = True

    def look(self, now: float, seen: Seen) -> Knowledge | None:
        """Return the knowledge for a decision at a time, if it needs any."""

    def decide(self, now: float, seen: Seen) -> None:
        """Decide at a time how to move until the next decision."""
        raise NotImplementedError

    def pose_at(self, time: float) -> Pose:
        """Return the pose at a time before the next decision."""
        raise NotImplementedError

    def advance(self, until: float) -> None:
        """Move to a time, at most that of the next decision."""
        self.pose = self.pose_at(until)


class FloorAgent(DecisionMaker):
    """Strategy of a template that sees all others exactly."""

    identity: PlayerIdentity

    def __init__(
        self,
        strategy: Strategy,
        limits: Limits,
        identity: PlayerIdentity,
        others: Sequence[PlayerIdentity],
        *,
        target: str = "",
        obstacles: ObstacleSet = NO_OBSTACLES,
    ) -> None:
        """Begin without knowledge.

        Without the name of a target it is the nearest opponent; known
        obstacles are in the world.
        """
        super().__init__(strategy, limits)
        self.identity, self.obstacles = identity, obstacles
        self._ids = tuple(each for each in others if each != identity)
        self._target, self._present = target, ""
        self._before: tuple[float, Seen] = (0.0, {})

    def look(
        self, now: float, seen: Seen, *, moving: bool
    ) -> Knowledge | None:
        """Return the knowledge at a time, in [s]; None without others."""
        own = seen[self.identity.name]
        known = tuple([self._other(who, now, own, seen) for who in self._ids])
        if not known:
            return None
        self._before, opponent = (now, seen), known[0]
        if len(known) > 1:
            present = choose_opponent(
                self.identity,
                {each.identity: each.distance for each in known},
                target=self._target,
                present=self._present,
            )
            if present != self._present:
                self._present = present
                self.reset_rates()
            opponent = next(o for o in known if o.identity.name == present)
        x, y, _ = seen[opponent.identity.name]
        self._track = track = self._track.note(now, (x, y), own)
        return Knowledge(
            now,
            opponent.bearing,
            opponent.distance,
            self.limits,
            *track.sight_rates,
            0.0,
            own,
            moving,
            self.obstacles,
            opponent.velocity,
            identity=self.identity,
            others=known,
        )

    def _other(
        self, who: PlayerIdentity, now: float, own: Pose, seen: Seen
    ) -> OtherPlayer:
        """Return another player in the frame of the own pose."""
        x, y, _ = seen[who.name]
        dx, dy = x - own.x, y - own.y
        then, before = self._before
        velocity = None
        if before and now > then:
            was = before[who.name]
            passed = now - then
            rates = (x - was.x) / passed, (y - was.y) / passed
            velocity = turned(rates, -own.theta)
        bearing = wrap_angle(atan2(dy, dx) - own.theta)
        return OtherPlayer(who, bearing, hypot(dx, dy), velocity)


class FloorWalk(FloorMotion):
    """Template of a robot, or unicycle.

    It follows the arc of its last decision for a step, or a part of it.
    """

    agent: FloorAgent

    def __init__(
        self,
        agent: FloorAgent,
        pose: Pose,
        *,
        parts: int = 1,
        delay: float = 0.0,
        alert: float | None = None,
        walls: ObstacleSet = NO_OBSTACLES,
        radius: float = 0.0,
    ) -> None:
        """Begin standing; it decides so many times, ``parts``, in a step.

        A start is delayed, in [s]. ``alert`` is the time between decisions
        while it stands, in [s], by default as it walks. Walls stop a body of
        a radius, in [m].
        """
        self.agent, self.pose = agent, pose
        self.is_walking = False
        # Processor times of decisions, in [s], noted if it is a list.
        self.decision_times: list[float] | None = None
        self._parts, self._delay = parts, delay
        self._alert = alert or agent.limits.step_duration / parts
        self._walls, self.radius = walls, radius
        self._known: tuple[float, Knowledge | None] = (-inf, None)
        self._share = agent.limits.share  # of a turn in a step
        self._since = 0.0  # time of the pose, or of the begin of its motion
        self._left = (0.0, 0.0)  # way [m] and turn [rad] until the decision

    def look(self, now: float, seen: Seen) -> Knowledge | None:
        """Return the knowledge for the decision at a time."""
        if self._known[0] != now:
            known = self.agent.look(now, seen, moving=self.is_walking)
            self._known = now, known
        return self._known[1]

    def decide(self, now: float, seen: Seen) -> None:
        """Decide, and follow the intent until the next decision."""
        noted = self.decision_times
        begun = 0.0 if noted is None else thread_time()
        known = self.look(now, seen)
        intent = None if known is None else self.agent.evaluate(known)
        if noted is not None:
            noted.append(thread_time() - begun)
        limits, parts = self.agent.limits, self._parts
        duration, self._since = limits.step_duration / parts, now
        if intent is None or not intent.walks:
            self.is_walking, self.due = False, now + self._alert
            return
        if not self.is_walking:
            self._since += self._delay
        self.is_walking, self.due = True, self._since + duration
        strategy, share = self.agent.strategy, self._share
        turn, most = share * intent.heading, pi * share
        if strategy.saturated:  # rate of (6), up to the bearing
            turn, most = intent.heading, share
        turn = min(max(turn, -most), most)
        way = intent.speed_factor
        if limits.outer_stride is not None:
            way = min(way, limits.stride_share(turn))
        if strategy.direction is Direction.BACKWARD:
            way = -way
        self._left = way * limits.stride / parts, turn / parts

    def pose_at(self, time: float) -> Pose:
        """Return the pose at a time before the next decision, in [s]."""
        if not self.is_walking or time <= self._since:
            return self.pose
        share, (way, turn) = self._share_at(time), self._left
        pose = self.pose.along_arc(share * way, share * turn)
        if self._walls is NO_OBSTACLES:
            return pose
        start, end, radius = self.pose[:2], pose[:2], self.radius
        x, y = stop_at(self._walls.packed, start, end, radius)
        return Pose(x, y, pose.theta)

    def advance(self, until: float) -> None:
        """Move to a time, in [s]."""
        if self.is_walking and until > self._since:
            left, (way, turn) = 1.0 - self._share_at(until), self._left
            self.pose, self._since = self.pose_at(until), until
            self._left = left * way, left * turn

    def _share_at(self, time: float) -> float:
        """Return the share of the motion until the decision at a time."""
        return (time - self._since) / (self.due - self._since)


class FloorWorld:
    """World of a game without bodies; see :class:`~.game.PlayedWorld`.

    Attributes:
        motions: Motion of each player, by name.
        until: Time of the next decision, in [s].
    """

    contact = Outcome.TOUCHED

    def __init__(
        self,
        motions: Mapping[str, FloorMotion],
        obstacles: ObstacleSet = NO_OBSTACLES,
        bodies: Sequence[str] = (),
    ) -> None:
        """Place the players; bodies that touch obstacles end the game."""
        self.motions, self.time, self.until = dict(motions), 0.0, 0.0
        self.acting = ""
        self._seen = {name: own.pose for name, own in self.motions.items()}
        self._obstacles = obstacles
        self._bodies = {
            name: own
            for name, own in self.motions.items()
            if name in bodies and isinstance(own, FloorWalk)
        }

    @property
    def strategies(self) -> dict[str, Strategy]:
        """Strategies of the players that decide, by name."""
        return {
            name: own.agent.strategy
            for name, own in self.motions.items()
            if own.agent is not None
        }

    def states(self) -> dict[str, Pose]:
        """Return the pose of each player in the world, by name."""
        return self._seen

    def is_moving(self, name: str) -> bool:
        """Return whether a player walks."""
        return self.motions[name].is_walking

    def due(
        self, names: Collection[str], *, ended: bool
    ) -> dict[str, Knowledge]:
        """Return what players know for decisions that are due, by name.

        At the end of a game that is each.
        """
        now, motions = self.time, self.motions
        due = [n for n in names if ended or motions[n].due <= now + AT_ONCE]
        found = {n: motions[n].look(now, self._seen) for n in due}
        return {n: known for n, known in found.items() if known is not None}

    def decide(self) -> None:
        """Let the players decide that are due, all from the same state."""
        now = self.time + AT_ONCE
        for name, motion in self.motions.items():
            if motion.due <= now:
                self.acting = name
                motion.decide(self.time, self._seen)
        self.until = min([motion.due for motion in self.motions.values()])

    def step(self, limit: float = inf) -> None:
        """Move all players to the next decision, or to a time, in [s]."""
        self.time = min(self.until, limit)
        for motion in self.motions.values():
            motion.advance(self.time)
        self._seen = {name: own.pose for name, own in self.motions.items()}

    def apart(self, one: str, other: str) -> float:
        """Return the distance between two players, in [m]."""
        (x, y, _), (u, v, _) = self._seen[one], self._seen[other]
        return hypot(u - x, v - y)

    def fallen(self) -> tuple[str, ...]:
        """Return no names: nobody falls."""
        return ()

    def touching(self) -> tuple[str, ...]:
        """Return the names of the players at an obstacle."""
        return tuple(
            [
                name
                for name, own in self._bodies.items()
                if touches(self._obstacles.packed, *own.pose[:2], own.radius)
            ]
        )

    def close(self) -> None:
        """Do nothing: it holds no resources."""


class FloorRecorder(GameObserver):
    """Observer that samples the poses of all players on the floor."""

    def __init__(self, world: FloorWorld, period: float = 0.0) -> None:
        """Sample in each period, in [s]; 0 for one sample at each decision."""
        self.world, self._period = world, period
        self._times: list[float] = []
        self._rows: list[Sequence[Pose]] = []

    @property
    def times(self) -> Array:
        """Times of the samples, in [s]. Shape (n,)."""
        return np.array(self._times)

    def acted(self, game: GameInPlay) -> None:
        """Sample the motion up to the next decision."""
        world, period = self.world, self._period
        if not period:
            self._note(world.time, list(world.states().values()))
            return
        until = min(world.until, game.rules.duration)
        while (time := period * len(self._times)) < until - AT_ONCE:
            motions = world.motions.values()
            self._note(time, [own.pose_at(time) for own in motions])

    def ended(self, game: GameInPlay) -> None:
        """Take the last sample."""
        time = self.world.time
        if not self._times or self._times[-1] < time - AT_ONCE:
            self._note(time, list(self.world.states().values()))

    def _note(self, time: float, poses: Sequence[Pose]) -> None:
        self._times.append(time)
        self._rows.append(poses)

    def poses(self) -> dict[str, Array]:
        """Return the poses of each player. Shapes (n, 3)."""
        found = np.array(self._rows).reshape(len(self._times), -1, 3)
        return {
            name: found[:, number]
            for number, name in enumerate(self.world.motions)
        }

    def tracks(self) -> dict[str, Trajectory]:
        """Return the trajectories, with each CoM on the floor, by name."""
        tracks = {}
        for name, poses in self.poses().items():
            poses[:, 2] = np.unwrap(poses[:, 2])
            tracks[name] = Trajectory(poses * ON_FLOOR, poses, poses)
        return tracks
