"""Game of an approaching pursuer and the template of an evader."""

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, hypot

import numpy as np

from ..core.poses import Array, Pose, wrap_angle
from ..locomotion.locomotion import MotionRequest, template_velocity
from ..planning import GaitSettings
from ..planning.path import UnicycleTrajectory
from ..sim.person_motion import PersonMotion, Place
from ..strategies.knowledge import Intent, Knowledge, Limits, limits_of
from ..strategies.strategy import Strategy, evaluate_strategy
from ..strategies.velocity_set import STILL, VelocitySet, respond

STEP = 0.01  # of the integration, in [s]


@dataclass(frozen=True, slots=True, eq=False)
class TemplateGame:
    """Motion of pursuer and evader in a finished game of templates.

    Attributes:
        times: Times of the samples, in [s]. Shape (n,).
        pursuer: Poses (x, y, heading) in the world, in [m] and [rad]. Shape
            (n, 3).
        evader: Poses of the evader, likewise. Shape (n, 3).
    """

    times: Array
    pursuer: Array
    evader: Array

    @property
    def closest_m(self) -> float:
        """Closest approach, in [m]."""
        offset = self.evader[:, :2] - self.pursuer[:, :2]
        return float(np.hypot(offset[:, 0], offset[:, 1]).min())


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
    """Play the template of an evader against a prescribed motion.

    The evader is a unicycle in path time that knows position and velocity of
    its opponent exactly. It decides once per footstep; while it stands it
    decides at any time, and moves after its first double support.

    Args:
        motion: Returns the motion of the pursuer from its initial pose and
            the evader's position.
        start: Initial pose of the pursuer in the world.
        evader: Initial pose of the evader in the world.
        strategy: Strategy of the evader.
        gait: Gait of the evader.
        duration: Duration of the game, in [s].
        ready: Time before which the evader does not walk, in [s].
        step: Step of the integration, in [s].

    Returns:
        Motion of both.
    """
    limits = limits_of(gait)
    memory = strategy.begin()
    pose = begun = evader
    walk = motion(start, (evader.x, evader.y))
    rows = [(*walk.pose, *pose)]
    intent: Intent | None = None  # None: the evader stands
    drives_from, decides_at = 0.0, ready
    velocity = (0.0, 0.0)
    for i in range(round(duration / step)):
        now = i * step
        if now >= decides_at - 1e-9:
            moving = intent is not None
            known = _known(now, pose, walk.pose, velocity, limits, moving)
            intent, memory = evaluate_strategy(strategy, known, memory)
            begun = pose
            if not intent.walks:
                intent = None
            else:
                delay = 0.0 if moving else gait.start_support / intent.pace
                drives_from = now + delay
                decides_at = drives_from + gait.step_duration / intent.pace
        before = walk.pose
        walk.advance(now + step, step, (pose.x, pose.y))
        velocity = (
            (walk.pose.x - before.x) / step,
            (walk.pose.y - before.y) / step,
        )
        if intent is not None and now + step > drives_from:
            pose = _pose_in_step(
                begun, intent, gait, strategy, now + step - drives_from
            )
        rows.append((*walk.pose, *pose))
    poses = np.array(rows)
    times: Array = step * np.arange(len(rows), dtype=np.float64)
    return TemplateGame(times, poses[:, :3], poses[:, 3:])


def play_point(
    motion: Callable[[Pose, Place], PersonMotion],
    start: Pose,
    evader: Pose,
    strategy: Strategy,
    gait: GaitSettings,
    velocities: VelocitySet,
    *,
    duration: float,
    step: float = STEP,
) -> TemplateGame:
    """Play the point that stands for legs against a prescribed motion.

    The point walks in any direction. Its velocity follows the commands with
    the lags of the legs, and it knows position and velocity of its opponent
    exactly.

    Args:
        motion: Returns the motion of the pursuer from its initial pose and
            the evader's position.
        start: Initial pose of the pursuer in the world.
        evader: Initial pose of the evader in the world.
        strategy: Strategy of the evader.
        gait: Speed, steering gain and decision interval of headings.
        velocities: Velocities that the legs deliver, and how fast.
        duration: Duration of the game, in [s].
        step: Step of the integration, in [s].

    Returns:
        Motion of both.
    """
    from ..locomotion.policy.policy_walk import decision_interval

    limits = limits_of(gait, velocities)
    memory, pose = strategy.begin(), evader
    walk = motion(start, (evader.x, evader.y))
    rows = [(*walk.pose, *pose)]
    command = actual = STILL
    over_floor, decides_at = (0.0, 0.0), 0.0
    for i in range(round(duration / step)):
        now = i * step
        if now >= decides_at - 1e-9:
            moving = command != STILL
            known = _known(now, pose, walk.pose, over_floor, limits, moving)
            intent, memory = evaluate_strategy(strategy, known, memory)
            request = MotionRequest(
                intent, strategy.direction, strategy.saturated
            )
            command = velocities.nearest(template_velocity(request, gait))
            if command != STILL:
                decides_at = now + decision_interval(intent, gait)
        before = walk.pose
        walk.advance(now + step, step, (pose.x, pose.y))
        over_floor = (
            (walk.pose.x - before.x) / step,
            (walk.pose.y - before.y) / step,
        )
        actual = respond(actual, command, velocities.lags, step)
        pose = pose.compose(Pose(*(step * value for value in actual)))
        rows.append((*walk.pose, *pose))
    poses = np.array(rows)
    times: Array = step * np.arange(len(rows), dtype=np.float64)
    return TemplateGame(times, poses[:, :3], poses[:, 3:])


def _known(
    now: float,
    pose: Pose,
    person: Pose,
    velocity: tuple[float, float],
    limits: Limits,
    moving: bool,
) -> Knowledge:
    """Return the exact knowledge of an evader at a pose."""
    x, y = person.x - pose.x, person.y - pose.y
    rotation = Pose(0.0, 0.0, -pose.theta)
    velocity_in_evader = rotation.compose(Pose(*velocity, 0.0))
    return Knowledge(
        now,
        wrap_angle(atan2(y, x) - pose.theta),
        hypot(x, y),
        limits,
        pose_in_map=pose,
        moving=moving,
        velocity=velocity_in_evader[:2],
    )


def _pose_in_step(
    begun: Pose,
    intent: Intent,
    gait: GaitSettings,
    strategy: Strategy,
    since: float,
) -> Pose:
    """Return the pose of the template at a time since the step began."""
    turn = gait.gain * intent.heading * gait.path_interval
    speed_factor = min(intent.speed_factor, gait.stride_share(turn))
    path = UnicycleTrajectory(
        intent.heading,
        speed_factor * gait.speed,
        gait.gain,
        strategy.direction,
        strategy.saturated,
    )
    time_scale = intent.pace * gait.path_interval / gait.step_duration
    path_time = since * time_scale
    return begun.compose(Pose(*path.poses([path_time])[0].tolist()))
