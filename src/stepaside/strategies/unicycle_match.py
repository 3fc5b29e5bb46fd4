"""Unicycle match: two strategies as unicycles that decide periodically."""

from dataclasses import dataclass
from math import ceil

import numpy as np

from ..core.errors import check_positive
from ..core.poses import Array, Pose
from ..planning.path import UnicycleTrajectory
from ..theory.unicycle.relative_coordinates import RelativeStart
from ..theory.unicycle.unicycle_game import Unicycle
from .decision_maker import TemplatePlayer
from .knowledge import Intent, Limits
from .strategy import Strategy

SAMPLES = 8  # recorded between two decisions


@dataclass(frozen=True, slots=True)
class StrategyRun:
    """Recorded match of two unicycles.

    Attributes:
        times: Times, in [s]. Shape (n,).
        pursuer: Poses (x [m], y [m], theta [rad]). Shape (n, 3).
        evader: Poses of the evader, likewise.
        captured: Whether the distance fell to the capture distance, which
            ends the match.
    """

    times: Array
    pursuer: Array
    evader: Array
    captured: bool

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


class _UnicyclePlayer(TemplatePlayer):
    """Unicycle that drives along its decisions."""

    def __init__(
        self, strategy: Strategy, body: Unicycle, pose: Pose, period: float
    ) -> None:
        limits = Limits(body.speed, body.gain, body.speed * period, period)
        super().__init__(strategy, limits, pose)
        self.body = body

    def drive(self, intent: Intent, times: Array) -> Array:
        """Drive along a decision; poses at times since then. Shape (n, 3)."""
        if not intent.walks:
            return np.tile(self.pose, (len(times), 1))
        path = UnicycleTrajectory(
            intent.heading,
            intent.speed_factor * self.body.speed,
            self.body.gain,
            self.strategy.direction,
            self.strategy.saturated,
        ).poses(intent.pace * times)
        path[:, :2] = self.pose.transform_points(path[:, :2])
        path[:, 2] += self.pose.theta
        self.pose = Pose(*path[-1].tolist())
        return path


def play_strategies(
    pursuer: Strategy,
    evader: Strategy,
    start: RelativeStart,
    *,
    bodies: tuple[Unicycle, Unicycle],
    period: float,
    duration: float,
    capture_distance: float = 1e-6,
) -> StrategyRun:
    r"""Play a match of two unicycles, each with a strategy.

    Both decide at the same instants and follow the trajectory (9)-(14) of
    the chosen maneuver until the next decision: with
    :math:`\Delta / \bar{v}` as the period, step by step, as walkers do; with
    a short period as unicycles under feedback. Time is path time. A standing
    player starts at the next decision.

    Args:
        pursuer: Strategy of the pursuer, which starts at the origin.
        evader: Strategy of the evader.
        start: Initial relative coordinates.
        bodies: Speeds and gains of pursuer and evader.
        period: Time between two decisions, in [s].
        duration: Time limit, in [s]; rounded up to whole periods.
        capture_distance: Distance at which the match ends, in [m].

    Raises:
        PlanError: If a value is out of its range, or a strategy requests an
            invalid motion.
    """
    for body in bodies:
        check_positive(body.speed, "speed", "m/s")
        check_positive(body.gain, "gain", "1/s")
    check_positive(period, "period", "s")
    check_positive(duration, "duration", "s")
    check_positive(capture_distance, "capture_distance", "m")
    origin = Pose(0.0, 0.0, 0.0)
    players = (
        _UnicyclePlayer(pursuer, bodies[0], origin, period),
        _UnicyclePlayer(evader, bodies[1], start.evader_pose(origin), period),
    )
    parts = period * np.arange(1, SAMPLES + 1) / SAMPLES
    tracks = [[np.array([player.pose])] for player in players]
    times = [np.zeros(1)]
    captured = start.distance <= capture_distance
    for step in range(ceil(duration / period - 1e-9)):
        if captured:
            break
        poses = [player.pose for player in players]
        distance, a, psi = RelativeStart.from_world(*poses).wrapped()
        intents = [
            player.decide(step * period, bearing, distance)
            for player, bearing in zip(players, (a, psi), strict=True)
        ]
        ways = [
            player.drive(intent, parts)
            for player, intent in zip(players, intents, strict=True)
        ]
        apart = np.hypot(*(ways[1] - ways[0])[:, :2].T)
        captures = np.flatnonzero(apart <= capture_distance)
        captured = captures.size > 0
        count = int(captures[0]) + 1 if captured else SAMPLES
        times.append(step * period + parts[:count])
        for track, way in zip(tracks, ways, strict=True):
            track.append(way[:count])
    driven, evaded = (np.concatenate(track) for track in tracks)
    return StrategyRun(np.concatenate(times), driven, evaded, captured)
