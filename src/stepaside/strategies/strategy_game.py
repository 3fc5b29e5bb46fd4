"""Games of two strategies with template unicycles, without physics.

Rules say when players decide and how they move until the next decision:
:class:`StepGame` by whole footsteps, :class:`UnicycleMatch` along the
trajectory of Sec. III-B.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from math import atan2, ceil, hypot, inf, pi, tau
from time import thread_time
from typing import ClassVar, NamedTuple

import numpy as np

from ..arena import NO_OBSTACLES, OPEN_FLOOR, Room
from ..arena.obstacles import PackedObstacles
from ..core.brief_repr import brief_repr
from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import check_bearing, check_positive, check_within
from ..core.poses import Array, Pose, arc, wrap_angle
from ..planning import Direction
from ..planning.path import UnicycleTrajectory
from ..theory.unicycle.unicycle_game import Unicycle
from .decision_maker import TemplatePlayer
from .knowledge import Intent, Limits
from .search.distance_field import clearance_at
from .strategy import Strategy

SAMPLES = 8  # of a unicycle match, between two decisions


class StrategyOutcome(StrEnum):
    """Outcome of a game of strategies."""

    SURVIVED = "survived"
    CAPTURED = "captured"
    TOUCHED = "touched"


@dataclass(frozen=True, slots=True)
class StepGame:
    """Rules of a game by footsteps; times are path times.

    Attributes:
        stride: Length of a step, in [m].
        speed: Speed of the template, in [m/s].
        gain: Steering gain k of both, in [1/s].
        largest_turn: Largest turn of a step, in [rad]; by default that of eq.
            (2), pi times gain times stride over speed.
        capture: Capture distance, in [m]: at it or below it the evader is
            captured.
        body_radius: Clearance of the evader's centre below which it touches
            an obstacle, in [m].
        solid_pursuer: Whether obstacles stop the pursuer; otherwise it walks
            through them.
        duration: Duration of a game, in [s].
        decisions: Decisions per step; with more than one, the players
            approximate unicycles under feedback.
        pursuer_speed_ratio: Speed and stride of the pursuer over those of
            the evader; its turns are the same.
    """

    knows_velocity: ClassVar = False  # of the opponent
    stride: float = 0.04
    speed: float = 0.1
    gain: float = 0.2
    largest_turn: float | None = None
    capture: float = CAPTURE_DISTANCE
    body_radius: float = 0.2
    solid_pursuer: bool = False
    duration: float = 180.0
    decisions: int = 1
    pursuer_speed_ratio: float = 1.0

    def __post_init__(self) -> None:
        """Validate the rules."""
        check_positive(self.stride, "stride", "m")
        check_positive(self.speed, "speed", "m/s")
        check_positive(self.gain, "gain", "1/s")
        check_positive(self.capture, "capture", "m")
        check_positive(self.body_radius, "body_radius", "m")
        check_positive(self.duration, "duration", "s")
        check_within(self.decisions, 1, 100, "decisions", "1")
        ratio = self.pursuer_speed_ratio
        check_within(ratio, 0.1, 10.0, "pursuer_speed_ratio", "1")
        if self.largest_turn is not None:
            check_positive(self.largest_turn, "largest_turn", "rad")
            check_bearing(self.largest_turn, "largest_turn")

    @property
    def period(self) -> float:
        """Duration of a step, in [s]."""
        return self.stride / self.speed

    @property
    def share(self) -> float:
        """Turn of a step per desired heading, kappa."""
        return self.gain * self.period

    @property
    def turn(self) -> float:
        """Largest turn of a step, in [rad]."""
        if self.largest_turn is None:
            return pi * self.share
        return self.largest_turn

    @property
    def limits(self) -> tuple[Limits, Limits]:
        """Limits of the gaits of pursuer and evader."""
        evader = Limits(self.speed, self.gain, self.stride, self.period)
        ratio = self.pursuer_speed_ratio
        pursuer = replace(
            evader, speed=ratio * self.speed, stride=ratio * self.stride
        )
        return pursuer, evader

    @property
    def decision_times(self) -> list[float]:
        """Times of all decisions, in [s]."""
        count = max(1, round(self.duration * self.decisions / self.period))
        return [n * self.period / self.decisions for n in range(count)]

    @property
    def sample_times(self) -> Array:
        """Times of recorded poses since a decision, in [s]. Shape (1,)."""
        return np.array([self.period / self.decisions])

    def move(self, player: TemplatePlayer, intent: Intent) -> list[Pose]:
        """Return the pose in the room after the exact arc of a maneuver."""
        if not intent.walks:
            return [player.pose]
        if player.strategy.saturated:  # rate of (6), up to the bearing
            turn, most = intent.heading, min(self.share, self.turn)
        else:
            turn, most = self.share * intent.heading, self.turn
        turn = min(max(turn, -most), most) / self.decisions
        way = player.limits.stride / self.decisions * intent.speed_factor
        if player.strategy.direction is Direction.BACKWARD:
            way = -way
        x, y, theta = player.pose.compose(Pose(*arc(way, 0.0, turn).tolist()))
        return [Pose(x, y, theta % tau)]


@dataclass(frozen=True, slots=True)
class UnicycleMatch:
    r"""Rules of a match of unicycles that decide periodically.

    Both follow the trajectory (9)-(14) of the chosen maneuver until the next
    decision: with :math:`\Delta / \bar{v}` as the period, step by step, as
    walkers do; with a short period as unicycles under feedback. Time is path
    time. A standing player starts at the next decision.

    Attributes:
        bodies: Speeds and gains of pursuer and evader.
        period: Time between two decisions, in [s].
        duration: Time limit, in [s]; rounded up to whole periods.
        capture: Distance at which the match ends, in [m].
    """

    knows_velocity: ClassVar = True
    body_radius: ClassVar = 0.0  # unicycles are points
    solid_pursuer: ClassVar = False
    bodies: tuple[Unicycle, Unicycle]
    period: float
    duration: float
    capture: float = 1e-6

    def __post_init__(self) -> None:
        """Validate the rules."""
        for body in self.bodies:
            check_positive(body.speed, "speed", "m/s")
            check_positive(body.gain, "gain", "1/s")
        check_positive(self.period, "period", "s")
        check_positive(self.duration, "duration", "s")
        check_positive(self.capture, "capture", "m")

    @property
    def limits(self) -> tuple[Limits, Limits]:
        """Limits of pursuer and evader."""
        pursuer, evader = (
            Limits(b.speed, b.gain, b.speed * self.period, self.period)
            for b in self.bodies
        )
        return pursuer, evader

    @property
    def decision_times(self) -> list[float]:
        """Times of all decisions, in [s]."""
        count = ceil(self.duration / self.period - 1e-9)
        return [n * self.period for n in range(count)]

    @property
    def sample_times(self) -> Array:
        """Times of recorded poses since a decision, in [s]. Shape (m,)."""
        return self.period * np.arange(1, SAMPLES + 1) / SAMPLES

    def move(self, player: TemplatePlayer, intent: Intent) -> list[Pose]:
        """Return the poses in the room at the sample times of a decision."""
        if not intent.walks:
            return [player.pose] * SAMPLES
        limits = player.limits
        path = UnicycleTrajectory(
            intent.heading,
            intent.speed_factor * limits.speed,
            limits.gain,
            player.strategy.direction,
            player.strategy.saturated,
        ).poses(intent.pace * self.sample_times)
        path[:, :2] = player.pose.transform_points(path[:, :2])
        path[:, 2] += player.pose.theta
        return [Pose(*pose) for pose in path.tolist()]


class StrategyTrack(NamedTuple):
    """Recorded game of strategies.

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

    outcome: StrategyOutcome
    times: Array
    pursuer: Array
    evader: Array
    clearances: Array
    decision: float
    longest_decision: float

    def __repr__(self) -> str:
        """Return the fields in one short line."""
        return brief_repr(self)

    @property
    def captured(self) -> bool:
        """Whether the distance fell to the capture distance."""
        return self.outcome is StrategyOutcome.CAPTURED

    @property
    def bearings(self) -> Array:
        """Bearings of the pursuer from the evader, in [rad]. Shape (n,)."""
        poses = zip(self.evader.tolist(), self.pursuer.tolist(), strict=True)
        return np.array([_bearing(Pose(*e), Pose(*p)) for e, p in poses])

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
    game: StepGame | UnicycleMatch | None = None,
) -> StrategyTrack:
    """Play a game without physics; both players decide at the same instants.

    Args:
        pursuer: Strategy of the pursuer.
        evader: Strategy of the evader.
        starts: Initial poses of pursuer and evader in the room.
        room: Room; the evader knows all obstacles, and so does a pursuer
            that they stop.
        game: Rules; by default those of :class:`StepGame`.

    Raises:
        PlanError: If a strategy requests an invalid motion.
        StrategyError: If a strategy returns no intent.
    """
    game = game or StepGame()
    hunter, prey = place_players(game, (pursuer, evader), starts, room)
    packed = room.solid_set.packed
    outcome = StrategyOutcome.SURVIVED
    samples: list[tuple[float, Pose, Pose, float]] = []
    decisions: list[float] = []
    for time, *poses in _moves(game, hunter, prey, decisions):
        clearance, outcome = judge_poses(game, packed, (poses[0], poses[1]))
        samples.append((time, poses[0], poses[1], clearance))
        if outcome is not StrategyOutcome.SURVIVED:
            break
    times, hunted, evaded, clearances = zip(*samples, strict=True)
    later = decisions[1:] or decisions or [0.0]
    return StrategyTrack(
        outcome,
        np.array(times),
        np.array(hunted),
        np.array(evaded),
        np.array(clearances),
        float(np.mean(later)),
        max(decisions[1:], default=0.0),
    )


def place_players(
    game: StepGame | UnicycleMatch,
    strategies: tuple[Strategy, Strategy],
    starts: tuple[Pose, Pose],
    room: Room,
) -> tuple[TemplatePlayer, TemplatePlayer]:
    """Return pursuer and evader at their initial poses.

    Args:
        game: Rules.
        strategies: Strategies of pursuer and evader.
        starts: Initial poses of pursuer and evader in the room.
        room: Room.
    """
    # A pursuer that obstacles do not stop plans no detours.
    stops = room.solid_set if game.solid_pursuer else NO_OBSTACLES
    known = stops, room.solid_set
    pursuer, evader = (
        TemplatePlayer(*player, estimates_velocity=game.knows_velocity)
        for player in zip(strategies, game.limits, starts, known, strict=True)
    )
    return pursuer, evader


def _moves(
    game: StepGame | UnicycleMatch,
    pursuer: TemplatePlayer,
    evader: TemplatePlayer,
    decisions: list[float],
) -> Iterator[tuple[float, Pose, Pose]]:
    """Yield time [s] and poses of pursuer and evader, from the start on.

    Appends the time [s] that each decision of the evader took.
    """
    yield 0.0, pursuer.pose, evader.pose
    times = game.sample_times.tolist()
    for time in game.decision_times:
        begun = thread_time()
        evades = evader.decide(evader.see(time, pursuer.pose))
        decisions.append(thread_time() - begun)
        pursues = pursuer.decide(pursuer.see(time, evader.pose))
        moved = move_players(game, (pursuer, evader), (pursues, evades))
        for after, _ in zip(times, moved, strict=True):
            yield time + after, pursuer.pose, evader.pose


def move_players(
    game: StepGame | UnicycleMatch,
    players: tuple[TemplatePlayer, TemplatePlayer],
    intents: tuple[Intent, Intent],
) -> Iterator[None]:
    """Move both players to each sample time after a decision.

    Args:
        game: Rules.
        players: Pursuer and evader; their poses are updated.
        intents: What they decided.
    """
    pursuer, evader = players
    chase, flight = map(game.move, players, intents)
    for pursuer_pose, evader_pose in zip(chase, flight, strict=True):
        pursuer.pose = _stopped(pursuer, pursuer_pose, game.body_radius)
        evader.pose = evader_pose
        yield


def judge_poses(
    game: StepGame | UnicycleMatch,
    packed: PackedObstacles,
    poses: tuple[Pose, Pose],
) -> tuple[float, StrategyOutcome]:
    """Apply the rules to the poses of pursuer and evader.

    Args:
        game: Rules.
        packed: Obstacles of the room.
        poses: Poses of pursuer and evader in the room.

    Returns:
        Clearance of the evader's centre, in [m], and the outcome, which is
        survival while the game goes on.
    """
    pursuer, evader = poses
    clearance = clearance_at(packed, evader.x, evader.y, inf)
    if clearance < game.body_radius:
        return clearance, StrategyOutcome.TOUCHED
    if hypot(pursuer.x - evader.x, pursuer.y - evader.y) <= game.capture:
        return clearance, StrategyOutcome.CAPTURED
    return clearance, StrategyOutcome.SURVIVED


def _stopped(player: TemplatePlayer, pose: Pose, body_radius: float) -> Pose:
    """Return the next pose of a player that its obstacles stop."""
    packed = player.obstacles.packed
    if clearance_at(packed, pose.x, pose.y, body_radius) < body_radius:
        return Pose(player.pose.x, player.pose.y, pose.theta)
    return pose


def _bearing(pose: Pose, other: Pose) -> float:
    """Return the bearing of another pose in the frame of a pose, in [rad]."""
    sight = atan2(other.y - pose.y, other.x - pose.x)
    return wrap_angle(sight - pose.theta)
