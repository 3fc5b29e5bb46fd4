"""Step game: two strategies in a room, one footstep per decision."""

from dataclasses import dataclass
from enum import StrEnum
from math import atan2, cos, hypot, inf, pi, sin, tau
from time import perf_counter
from typing import NamedTuple

import numpy as np

from ..arena import NO_OBSTACLES, OPEN_FLOOR, ObstacleSet, Room
from ..core.brief_repr import brief_repr
from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import check_bearing, check_positive, check_within
from ..core.poses import Array, Pose, wrap_angle
from ..planning import Direction
from .decision_maker import TemplatePlayer
from .knowledge import Intent, Limits
from .search.distance_field import clearance_at
from .strategy import Strategy


class StepOutcome(StrEnum):
    """Outcome of a step game."""

    SURVIVED = "survived"
    CAPTURED = "captured"
    TOUCHED = "touched"


@dataclass(frozen=True, slots=True)
class StepGame:
    """Rules of the step game; times are path times.

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
    """

    stride: float = 0.04
    speed: float = 0.1
    gain: float = 0.2
    largest_turn: float | None = None
    capture: float = CAPTURE_DISTANCE
    body_radius: float = 0.2
    solid_pursuer: bool = False
    duration: float = 180.0
    decisions: int = 1

    def __post_init__(self) -> None:
        """Validate the rules."""
        check_positive(self.stride, "stride", "m")
        check_positive(self.speed, "speed", "m/s")
        check_positive(self.gain, "gain", "1/s")
        check_positive(self.capture, "capture", "m")
        check_positive(self.body_radius, "body_radius", "m")
        check_positive(self.duration, "duration", "s")
        check_within(self.decisions, 1, 100, "decisions", "1")
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
    def limits(self) -> Limits:
        """Limits of the gait of both players."""
        return Limits(self.speed, self.gain, self.stride, self.period)

    @property
    def steps(self) -> int:
        """Number of decisions of a game."""
        return max(1, round(self.duration * self.decisions / self.period))


class StepTrack(NamedTuple):
    """Recorded step game.

    Attributes:
        outcome: Outcome of the game.
        pursuer: Poses (x [m], y [m], theta [rad]), from the start on.
            Shape (n, 3).
        evader: Poses of the evader, likewise.
        bearings: Bearings of the pursuer in the evader's frame, in [rad].
            Shape (n,).
        clearances: Clearances of the evader's centre, in [m]. Shape (n,).
        decision: Mean time of a decision of the evader, without the first
            one, which loads code, in [s].
        longest_decision: Longest time of a decision, likewise.
    """

    outcome: StepOutcome
    pursuer: Array
    evader: Array
    bearings: Array
    clearances: Array
    decision: float
    longest_decision: float

    def __repr__(self) -> str:
        """Return the fields in one short line."""
        return brief_repr(self)

    @property
    def distances(self) -> Array:
        """Distance between the two after each step, in [m]. Shape (n,)."""
        apart = self.evader - self.pursuer
        found: Array = np.hypot(apart[:, 0], apart[:, 1])
        return found


class _StepPlayer(TemplatePlayer):
    """Player that moves by the arc of one decision."""

    def __init__(
        self,
        strategy: Strategy,
        pose: Pose,
        game: StepGame,
        solids: ObstacleSet,
    ) -> None:
        super().__init__(
            strategy, game.limits, pose, solids, estimates_velocity=False
        )
        self.game = game

    def bearing_of(self, other: Pose) -> float:
        """Return the bearing of a pose in the own frame, in [rad]."""
        x, y, theta = self.pose
        return wrap_angle(atan2(other.y - y, other.x - x) - theta)

    def decide_against(self, time: float, other: Pose) -> Intent:
        """Evaluate the strategy, with the opponent at a pose in the room."""
        x, y, _ = self.pose
        distance = hypot(other.x - x, other.y - y)
        return self.decide(time, self.bearing_of(other), distance)

    def after(self, intent: Intent) -> Pose:
        """Return the pose after a decision: the exact arc of the maneuver."""
        if not intent.walks:
            return self.pose
        game = self.game
        if self.strategy.saturated:  # rate of (6), up to the bearing
            turn, most = intent.heading, min(game.share, game.turn)
        else:
            turn, most = game.share * intent.heading, game.turn
        turn = min(max(turn, -most), most) / game.decisions
        half = 0.5 * turn
        way = (
            game.stride
            / game.decisions
            * intent.speed_factor
            * float(np.sinc(half / pi))
        )
        if self.strategy.direction is Direction.BACKWARD:
            way = -way
        x, y, theta = self.pose
        return Pose(
            x + way * cos(theta + half),
            y + way * sin(theta + half),
            (theta + turn) % tau,
        )


def play_steps(
    pursuer: Strategy,
    evader: Strategy,
    starts: tuple[Pose, Pose],
    *,
    room: Room = OPEN_FLOOR,
    game: StepGame | None = None,
) -> StepTrack:
    """Play a step game; both players decide at the same instants.

    Args:
        pursuer: Strategy of the pursuer.
        evader: Strategy of the evader.
        starts: Initial poses of pursuer and evader in the room.
        room: Room; the evader knows all obstacles, and so does a pursuer
            that they stop.
        game: Rules of the game.

    Raises:
        PlanError: If a value is out of its range.
    """
    game = game or StepGame()
    # A pursuer that walks through obstacles plans no detours.
    stops = room.solid_set if game.solid_pursuer else NO_OBSTACLES
    hunter = _StepPlayer(pursuer, starts[0], game, stops)
    prey = _StepPlayer(evader, starts[1], game, room.solid_set)
    packed = room.solid_set.packed
    ways: list[tuple[Pose, Pose]] = [(hunter.pose, prey.pose)]
    bearings = [prey.bearing_of(hunter.pose)]
    clearances = [clearance_at(packed, prey.pose.x, prey.pose.y, inf)]
    outcome = StepOutcome.SURVIVED
    decisions = []
    for n in range(game.steps):
        time = n * game.period / game.decisions
        begun = perf_counter()
        wanted = prey.decide_against(time, hunter.pose)
        decisions.append(perf_counter() - begun)
        chasing = hunter.decide_against(time, prey.pose)
        moved = hunter.after(chasing)
        if game.solid_pursuer:
            free = clearance_at(packed, moved.x, moved.y, game.body_radius)
            if free < game.body_radius:
                x, y, _ = hunter.pose
                moved = Pose(x, y, moved.theta)
        hunter.pose, prey.pose = moved, prey.after(wanted)
        x, y, _ = prey.pose
        ways.append((hunter.pose, prey.pose))
        bearings.append(prey.bearing_of(hunter.pose))
        clearances.append(clearance_at(packed, x, y, inf))
        if clearances[-1] < game.body_radius:
            outcome = StepOutcome.TOUCHED
            break
        if hypot(x - hunter.pose.x, y - hunter.pose.y) <= game.capture:
            outcome = StepOutcome.CAPTURED
            break
    poses = np.array(ways)
    return StepTrack(
        outcome,
        poses[:, 0],
        poses[:, 1],
        np.array(bearings),
        np.array(clearances),
        float(np.mean(decisions[1:] or decisions)),
        float(max(decisions[1:], default=0.0)),
    )
