"""A person who comes, and the template of an evader that steps aside."""

from collections.abc import Callable
from math import atan2, hypot

from ..planning import GaitSettings
from ..planning.path import UnicycleTrajectory
from ..poses import Pose, wrap_angle
from ..strategies.knowledge import Intent, Knowledge, Limits
from ..strategies.strategy import Strategy
from ..world.person_motion import Motion, Place

STEP = 0.01  # of the integration, in [s]


def template_meeting(
    motion: Callable[[Pose, Place], Motion],
    start: Pose,
    evader: Pose,
    strategy: Strategy,
    gait: GaitSettings,
    *,
    duration: float,
    ready: float = 0.0,
) -> float:
    """Closest approach of a person to the template of an evader.

    The evader is a unicycle in gait time that plays its strategy and knows
    where the person is and walks to. It decides step by step; who stands
    decides at any time, and moves when its first double support is over.

    Args:
        motion: Begins a walk of the person.
        start: Where it begins.
        evader: Where the evader stands and heads.
        strategy: Of the evader.
        gait: How it walks.
        duration: How long to look, in [s].
        ready: Before this time it does not walk, in [s].

    Returns:
        Least distance, in [m].
    """
    limits = Limits(gait.speed, gait.gain, gait.stride, gait.step_duration)
    memory = strategy.begin()
    pose = begun = evader
    walk = motion(start, (evader.x, evader.y))
    least = _apart(pose, walk.pose)
    intent: Intent | None = None  # None: it stands
    drives_from, decides_at = 0.0, ready
    velocity = (0.0, 0.0)
    for i in range(round(duration / STEP)):
        now = i * STEP
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
        walk.advance(now + STEP, STEP, (pose.x, pose.y))
        velocity = (
            (walk.pose.x - before.x) / STEP,
            (walk.pose.y - before.y) / STEP,
        )
        if intent is not None and now + STEP > drives_from:
            pose = _driven(
                begun, intent, gait, strategy, now + STEP - drives_from
            )
        least = min(least, _apart(pose, walk.pose))
    return least


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
