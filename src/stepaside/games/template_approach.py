"""Somebody who comes, and the template of an evader that steps aside."""

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, hypot

import numpy as np

from ..core.poses import Array, Pose, wrap_angle
from ..planning import GaitSettings
from ..planning.path import UnicycleTrajectory
from ..sim.person_motion import PersonMotion, Place
from ..strategies.knowledge import Intent, Knowledge, Limits
from ..strategies.strategy import Strategy

STEP = 0.01  # of the integration, in [s]


@dataclass(frozen=True, slots=True, eq=False)
class TemplateGame:
    """A game of templates that was played.

    Attributes:
        times: Of the samples, in [s]. Shape (n,).
        pursuer: Its places and headings, in [m] and [rad]. Shape (n, 3).
        evader: Those of the evader.
    """

    times: Array
    pursuer: Array
    evader: Array

    @property
    def closest_m(self) -> float:
        """Closest approach, in [m]."""
        apart = self.evader[:, :2] - self.pursuer[:, :2]
        return float(np.hypot(apart[:, 0], apart[:, 1]).min())


def template_meeting(
    motion: Callable[[Pose, Place], PersonMotion],
    start: Pose,
    evader: Pose,
    strategy: Strategy,
    gait: GaitSettings,
    *,
    duration: float,
    ready: float = 0.0,
) -> float:
    """Closest approach of a person to the template of an evader, in [m].

    The arguments are those of :func:`play_template`.
    """
    played = play_template(
        *(motion, start, evader, strategy, gait),
        duration=duration,
        ready=ready,
    )
    return played.closest_m


def play_template(
    motion: Callable[[Pose, Place], PersonMotion],
    start: Pose,
    evader: Pose,
    strategy: Strategy,
    gait: GaitSettings,
    *,
    duration: float,
    ready: float = 0.0,
    step: float = STEP,
) -> TemplateGame:
    """Play the template of an evader against a motion.

    The evader is a unicycle in gait time that plays its strategy and knows
    where the other is and walks to. It decides step by step; while it stands
    it decides at any time, and moves when its first double support is over.

    Args:
        motion: Begins a walk of the other.
        start: Where it begins.
        evader: Where the evader stands and heads.
        strategy: Of the evader.
        gait: How it walks.
        duration: How long to look, in [s].
        ready: Before this time it does not walk, in [s].
        step: Of the integration, in [s].
    """
    limits = Limits(gait.speed, gait.gain, gait.stride, gait.step_duration)
    memory = strategy.begin()
    pose = begun = evader
    walk = motion(start, (evader.x, evader.y))
    rows = [(*walk.pose, *pose)]
    intent: Intent | None = None  # None: it stands
    drives_from, decides_at = 0.0, ready
    velocity = (0.0, 0.0)
    for i in range(round(duration / step)):
        now = i * step
        if now >= decides_at - 1e-9:
            moving = intent is not None
            known = _known(now, pose, walk.pose, velocity, limits, moving)
            intent, memory = strategy.decide(known, memory)
            begun = pose
            if not intent.walks:
                intent = None
            else:
                late = 0.0 if moving else gait.start_support / intent.pace
                drives_from = now + late
                decides_at = drives_from + gait.step_duration / intent.pace
        before = walk.pose
        walk.advance(now + step, step, (pose.x, pose.y))
        velocity = (
            (walk.pose.x - before.x) / step,
            (walk.pose.y - before.y) / step,
        )
        if intent is not None and now + step > drives_from:
            pose = _driven(
                begun, intent, gait, strategy, now + step - drives_from
            )
        rows.append((*walk.pose, *pose))
    poses = np.array(rows)
    times: Array = step * np.arange(len(rows), dtype=np.float64)
    return TemplateGame(times, poses[:, :3], poses[:, 3:])


def _apart(one: Pose, other: Pose) -> float:
    """Distance of two places, in [m]."""
    return hypot(other.x - one.x, other.y - one.y)


def _known(
    now: float,
    pose: Pose,
    person: Pose,
    velocity: tuple[float, float],
    limits: Limits,
    moving: bool,
) -> Knowledge:
    """What an evader at a pose knows that sees all there is."""
    bearing = atan2(person.y - pose.y, person.x - pose.x) - pose.theta
    turned = Pose(0.0, 0.0, -pose.theta).compose(Pose(*velocity, 0.0))
    return Knowledge(
        now,
        wrap_angle(bearing),
        _apart(pose, person),
        limits,
        pose=pose,
        moving=moving,
        velocity=turned[:2],
    )


def _driven(
    begun: Pose,
    intent: Intent,
    gait: GaitSettings,
    strategy: Strategy,
    since: float,
) -> Pose:
    """Where a step has come to, by the gait's own clock."""
    turn = gait.gain * intent.heading * gait.path_interval
    share = min(intent.speed_factor, gait.stride_share(turn))
    path = UnicycleTrajectory(
        intent.heading,
        share * gait.speed,
        gait.gain,
        strategy.direction,
        strategy.saturated,
    )
    pace = intent.pace * gait.path_interval / gait.step_duration
    passed = since * pace
    return begun.compose(Pose(*path.poses([passed])[0].tolist()))
