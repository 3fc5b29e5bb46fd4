"""Walk to a goal among other players."""

from dataclasses import dataclass, field
from math import cos, hypot, pi, sin
from typing import Any

import numpy as np

from ..core.poses import Pose, wrap_angle
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from .knowledge import STAND, Intent, Knowledge
from .pursuit import Pursuit, PursuitVariant

ARRIVED = 0.2  # distance from the goal at which it halts, in [m]
HORIZON = 4.0  # of the prediction, in [s]
DEVIATIONS = np.linspace(-pi / 2, pi / 2, 19)  # tried headings, in [rad]
WEIGHT = 4.0  # of a missing metre of clearance, in [rad]
SOON = 2.5  # time to a predicted contact at which it halts, in [s]


@dataclass(frozen=True, slots=True)
class GoalWalk(PursuitVariant):
    """Walk to a goal, giving way to others.

    Among headings to both sides of the way to the goal it takes the one that
    deviates least and keeps the clearance to every other player, all of
    which are predicted with constant velocities. It halts while none keeps
    clear of a contact.
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
    pursuit: Pursuit = field(default_factory=Pursuit)

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Head for the goal, beside others, and halt there."""
        if not self.goal:
            return STAND, memory
        x, y = self.goal
        there = knowledge.pose_in_map.inverse().compose(Pose(x, y, 0.0))
        if hypot(there.x, there.y) < ARRIVED:
            return STAND, memory
        intent, memory = self.pursuit.decide(
            knowledge.towards(there.x, there.y), memory
        )
        if not knowledge.others:
            return intent, memory
        heading = self._clear_heading(knowledge, intent.heading)
        if heading is None:
            return STAND, memory
        return Intent(wrap_angle(heading)), memory

    def _clear_heading(
        self, knowledge: Knowledge, wanted: float
    ) -> float | None:
        """Return the heading that keeps clear, in [rad]; None if none does."""
        limits = knowledge.limits
        speed = limits.stride / limits.step_duration
        directions = wanted + DEVIATIONS
        own = speed * np.stack([np.cos(directions), np.sin(directions)])
        costs, contact_times = np.abs(DEVIATIONS), []
        for other in knowledge.others:
            u, v = other.velocity or (0.0, 0.0)
            x = other.distance * cos(other.bearing) + u * other.age
            y = other.distance * sin(other.bearing) + v * other.age
            dx, dy = u - own[0], v - own[1]
            square = np.maximum(dx * dx + dy * dy, 1e-9)
            when = np.clip(-(x * dx + y * dy) / square, 0.0, HORIZON)
            least = np.hypot(x + when * dx, y + when * dy)
            costs = costs + WEIGHT * np.maximum(self.clearance - least, 0.0)
            contact_times.append(np.where(least < self.contact, when, np.inf))
        best = int(costs.argmin())
        approaching = min(times[best] for times in contact_times)
        if approaching < SOON:
            return None
        return float(directions[best])
