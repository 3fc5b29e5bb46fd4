"""Execution of a strategy: its memory, and the knowledge it decides from."""

from collections.abc import Mapping
from math import cos, sin
from pathlib import Path
from traceback import extract_tb
from typing import Any

from ..arena import NO_OBSTACLES, ObstacleSet
from ..core.errors import FAILURES, StrategyError
from ..core.player_identity import PlayerIdentity
from ..core.poses import Pose, wrap_angle
from ..perception.measurement import Sighting
from .knowledge import Intent, Knowledge, Limits, OtherPlayer
from .opponent_track import ORIGIN, OpponentTrack
from .strategy import Strategy, unicycle_intent

NEARER = 0.9  # relative distance from which another opponent is taken


class DecisionMaker:
    """Strategy of one player with its memory and rate estimates.

    The own identity is None if only one other player can be sighted, without
    its identity.
    """

    identity: PlayerIdentity | None = None

    def __init__(self, strategy: Strategy, limits: Limits) -> None:
        """Begin without a sighting."""
        self.strategy, self.limits = strategy, limits
        self.memory: Any = strategy.begin()
        self.reset_rates()

    def reset_rates(self) -> None:
        """Forget the motion of the opponent."""
        self._track = OpponentTrack(self.limits.step_duration)

    def adopt(self, strategy: Strategy) -> None:
        """Replace the strategy from the next decision on.

        One of the same class continues with the present memory.
        """
        if type(strategy) is not type(self.strategy):
            self.memory = strategy.begin()
        self.strategy = strategy

    def observe(
        self,
        now: float,
        pose_template_in_odometry: Pose,
        sighting: Sighting,
        *,
        pose_odometry_in_map: Pose = ORIGIN,
        moving: bool,
        obstacles: ObstacleSet = NO_OBSTACLES,
        map_error: float = 0.0,
        velocity: tuple[float, float] | None = None,
        others: tuple[OtherPlayer, ...] = (),
    ) -> Knowledge:
        """Add a sighting and return the knowledge for a decision.

        The pose of the template is that at the sighting, whose bearing is from
        there. A velocity in its axes [m/s] is given if it is known exactly,
        and others if several are known.
        """
        time, bearing, distance = sighting[:3]
        bearing, age = wrap_angle(bearing), max(0.0, now - time)
        pose = pose_template_in_odometry
        sight = pose.theta + bearing
        position = (
            pose.x + distance * cos(sight),
            pose.y + distance * sin(sight),
        )
        self._track = track = self._track.note(time, position, pose)
        bearing_rate, closing_speed = track.sight_rates
        if velocity is None:
            velocity = turned(track.velocity, -pose.theta)
        if not others and sighting.identity is not None:
            others = (
                OtherPlayer(
                    *(sighting.identity, bearing, distance),
                    *(velocity, age, sighting.spread),
                ),
            )
        return Knowledge(
            now,
            bearing,
            distance,
            self.limits,
            bearing_rate,
            closing_speed,
            age,
            pose_odometry_in_map.compose(pose),
            moving,
            obstacles,
            velocity,
            spread=sighting.spread,
            map_error=map_error,
            identity=self.identity,
            others=others,
        )

    def evaluate(self, knowledge: Knowledge) -> Intent:
        """Decide and store the memory."""
        intent, self.memory = evaluate_strategy(
            self.strategy, knowledge, self.memory
        )
        return intent


def turned(
    velocity: tuple[float, float] | None, angle: float
) -> tuple[float, float] | None:
    """Return a velocity [m/s] turned by an angle [rad]; None for none."""
    if velocity is None:
        return None
    (u, v), c, s = velocity, cos(angle), sin(angle)
    return c * u - s * v, s * u + c * v


def choose_opponent(
    own: PlayerIdentity,
    distances: Mapping[PlayerIdentity, float],
    *,
    target: str = "",
    present: str = "",
) -> str:
    """Return the name of the player that a player plays against.

    It is the assigned target. Without a target it is the nearest opponent,
    and another one than at present only when that is nearer by a tenth; in a
    game without opponents, the nearest player. The name is empty if no
    player has been seen.
    """
    if target:
        return target
    candidates = {
        other.name: distance
        for other, distance in distances.items()
        if own.opposes(other)
    } or {other.name: distance for other, distance in distances.items()}
    if not candidates:
        return ""
    nearest = min(candidates, key=lambda name: candidates[name])
    now = candidates.get(present)
    if now is not None and candidates[nearest] > NEARER * now:
        return present
    return nearest


def evaluate_strategy(
    strategy: Strategy, knowledge: Knowledge, memory: Any
) -> tuple[Intent, Any]:
    """Evaluate one decision of a strategy, possibly user code.

    A body velocity becomes the nearest intent of a unicycle, unless the legs
    have a velocity set. Raises :class:`StrategyError` if it fails or exits.
    """
    try:
        intent, memory = strategy.decide(knowledge, memory)
    except FAILURES as error:
        where = extract_tb(error.__traceback__)[-1]
        line = f"{Path(where.filename).name}, line {where.lineno}"
        raise StrategyError(
            f"{type(error).__name__}: {error} ({line})"
        ) from error
    if not isinstance(intent, Intent):
        raise StrategyError(f"decide must return an Intent, got {intent!r}")
    limits = knowledge.limits
    if intent.velocity is not None and limits.velocities is None:
        intent = unicycle_intent(intent, limits, strategy.direction)
    return intent, memory
