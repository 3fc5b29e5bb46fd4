"""Walk to a goal among other players."""

from dataclasses import dataclass
from math import cos, hypot, pi, sin

import numpy as np

from ..core.poses import Array, Pose, wrap_angle
from ..core.ranges import Range
from ..core.setting import setting
from .knowledge import STAND, Intent, Knowledge
from .pursuit import Pursuit, PursuitMemory
from .velocity_set import BodyVelocity, VelocitySet, greatest_velocity

ARRIVED = 0.2  # distance from the goal at which it halts, in [m]
HORIZON = 4.0  # of the prediction, in [s]
DEVIATIONS = np.linspace(-pi / 2, pi / 2, 19)  # tried headings, in [rad]
WEIGHT = 4.0  # of a missing metre of clearance, in [rad]
DIRECTIONS = 24  # of the velocities tried, in any direction
SHARES = (0.0, 0.5, 1.0)  # of the fastest velocity in a direction
REACTION = 0.5  # in which legs follow a new velocity, in [s]
WALL_WEIGHT = 20.0  # of a missing metre of clearance from walls, in [rad]
LOOKS = 5  # points along a heading at which walls are looked up
SOON = 2.5  # time to a predicted contact at which it halts, in [s]


@dataclass(frozen=True, slots=True)
class GoalWalk(Pursuit):
    """Walk to a goal, giving way to others.

    It takes the heading that deviates least from the way to the goal and
    keeps clear of every other player, at constant velocities, and halts while
    none does. Legs that walk in any direction choose among velocities
    likewise, by the progress that each loses.
    """

    goal: tuple[float, ...] = setting(
        (), "Goal (x, y) in the frame of the map [m]; none stands"
    )
    clearance: float = setting(
        0.8,
        "Distance that it keeps from others",
        Range(0.0, 10.0, "m", "beyond, no way is free"),
    )
    contact: float = setting(
        0.45,
        "Distance that counts as contact",
        Range(0.0, 10.0, "m", "the bodies have a width"),
    )

    def decide(
        self, knowledge: Knowledge, memory: PursuitMemory
    ) -> tuple[Intent, PursuitMemory]:
        """Head for the goal, beside others, and halt there."""
        if not self.goal:
            return STAND, memory
        x, y = self.goal
        there = knowledge.pose_in_map.inverse().compose(Pose(x, y, 0.0))
        if hypot(there.x, there.y) < ARRIVED:
            return STAND, memory
        aimed = knowledge.towards(there.x, there.y)
        intent, memory = Pursuit.decide(self, aimed, memory)
        velocities, bearing = knowledge.limits.velocities, aimed.bearing
        if velocities is not None:
            if knowledge.obstacles_in_map:
                bearing = self.path_bearing(aimed)
            return self._clear_velocity(knowledge, bearing, velocities), memory
        if knowledge.others:
            intent = self._clear_heading(knowledge, intent.heading)
        return intent, memory

    def _clear_heading(self, knowledge: Knowledge, wanted: float) -> Intent:
        """Return the heading that keeps clear; stand if none does."""
        limits = knowledge.limits
        speed = limits.stride / limits.step_duration
        directions = wanted + DEVIATIONS
        own = speed * np.stack([np.cos(directions), np.sin(directions)])
        least, when = nearest_passages(knowledge, own)
        missing = np.maximum(self.clearance - least, 0.0).sum(axis=0)
        costs = np.abs(DEVIATIONS) + WEIGHT * missing
        best = int((costs + self._wall_cost(knowledge, own)).argmin())
        contacts = when[:, best][least[:, best] < self.contact]
        if contacts.size and contacts.min() < SOON:
            return STAND
        return Intent(wrap_angle(float(directions[best])))

    def _clear_velocity(
        self, knowledge: Knowledge, bearing: float, velocities: VelocitySet
    ) -> Intent:
        """Return the velocity in any direction that keeps clear."""
        angles = bearing + np.linspace(-pi, pi, DIRECTIONS, endpoint=False)
        fastest = np.array(
            [greatest_velocity(each, velocities) for each in angles]
        ).T
        own = np.concatenate([s * fastest for s in SHARES], axis=1)
        progress = cos(bearing) * own[0] + sin(bearing) * own[1]
        least, when = nearest_passages(knowledge, own, earliest=REACTION)
        missing = np.maximum(self.clearance - least, 0.0)
        missing += np.maximum(self.contact - least, 0.0) / when
        costs = (progress.max() - progress) / max(progress.max(), 1e-9)
        costs = costs + WEIGHT * missing.sum(axis=0)
        best = int((costs + self._wall_cost(knowledge, own)).argmin())
        turn = knowledge.limits.gain * wrap_angle(bearing)
        wanted = BodyVelocity(float(own[0, best]), float(own[1, best]), turn)
        return Intent(velocity=velocities.nearest(wanted))

    def _wall_cost(self, knowledge: Knowledge, own: Array) -> Array:
        """Return the cost of own velocities, (2, n), towards obstacles."""
        solids, radius = knowledge.obstacles_in_map, self.body_radius
        if not solids:
            return np.zeros(own.shape[1])
        times = np.arange(1, LOOKS + 1) * (SOON / LOOKS)
        ahead = np.moveaxis(own[:, :, None] * times, 0, -1).reshape(-1, 2)
        points = knowledge.pose_in_map.transform_points(ahead)
        gaps = solids.clearance(points).reshape(-1, LOOKS).min(axis=1)
        cost: Array = WALL_WEIGHT * np.maximum(radius - gaps, 0.0)
        return cost


def nearest_passages(
    knowledge: Knowledge, own: Array, *, earliest: float = 0.0
) -> tuple[Array, Array]:
    """Predict the closest approach of each other player, at constant velocity.

    Own velocities (2, n) are those in the frame, in [m/s]; no choice changes
    approaches before the earliest time. Returns distances [m] and times from
    now [s], of shape (others, n).
    """
    rows = [
        (*other.position, *(other.velocity or (0.0, 0.0)), other.age)
        for other in knowledge.others
    ]
    x, y, u, v, age = np.array(rows).reshape(-1, 5).T[:, :, None]
    x, y, dx, dy = x + u * age, y + v * age, u - own[0], v - own[1]
    square = np.maximum(dx * dx + dy * dy, 1e-9)
    when = np.clip(-(x * dx + y * dy) / square, earliest, HORIZON)
    return np.hypot(x + when * dx, y + when * dy), when
