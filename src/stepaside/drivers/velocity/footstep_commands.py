"""Footsteps for a robot that walks where it is told to step.

Each is told relative to the other foot, as NAOqi does it.
"""

from dataclasses import dataclass
from math import cos, sin
from typing import NamedTuple

import numpy as np

from ...core.errors import ConfigurationError, check_positive, check_within
from ...core.poses import Pose
from ...planning import Direction, Foot, GaitSettings, UnicycleTrajectory
from ...planning.footsteps import place_footsteps
from ...planning.template_path import path_samples
from .velocity_body import VelocityCommand

CREEPING = 1e-6  # speed of a template that turns in place, in [m/s]


class FootCommand(NamedTuple):
    """Placement of one foot.

    Attributes:
        foot: Foot that lands.
        pose: Where, in the frame of the foot that supports it.
        time: When, in [s].
    """

    foot: Foot
    pose: Pose
    time: float


class PathSegment(NamedTuple):
    """Part of a path that one step walks.

    Attributes:
        length: Along the path, in [m], negative backward.
        turn: From its beginning to its end, in [rad].
        aside: What no path of a unicycle has, in [m], positive leftward.
    """

    length: float
    turn: float
    aside: float


@dataclass(frozen=True, slots=True)
class StepLimits:
    """What a robot's own walk accepts of one step.

    The default is what the vendor publishes of NAO's default gait.

    Attributes:
        stride: Longest way of a foot along the path, in [m].
        turn: Greatest turn of a step, in [rad].
        shortest: Least time of a step, in [s].
        longest: Most time of a step, in [s].
    """

    stride: float = 0.04
    turn: float = 0.349
    shortest: float = 0.42
    longest: float = 0.6

    def __post_init__(self) -> None:
        """Refuse limits that let nothing through."""
        error = ConfigurationError
        check_positive(self.stride, "stride", "m", error)
        check_within(self.turn, 1e-3, 1.5, "turn", "rad", error)
        check_positive(self.shortest, "shortest", "s", error)
        top = (self.shortest, 60.0)
        check_within(self.longest, *top, "longest", "s", error)


def plan_footsteps(
    velocity: VelocityCommand,
    gait: GaitSettings,
    limits: StepLimits,
    *,
    first_foot: Foot,
    count: int,
) -> tuple[FootCommand, ...]:
    r"""Footsteps of a template, as the paper's maneuvers have them.

    The template begins beside the support foot, on the path of eqs. (9) to
    (14) whose turning rate is the given one; feet land beside it (Sec.
    III-C). A step that is too long or turns too far is cut short on that
    path, which keeps its curvature.

    Args:
        velocity: Of the template: :math:`\pm \bar{v}` and
            :math:`k \theta^*`. Finite.
        gait: Gives stride, steering gain, foot spacing and time of a step.
        limits: What the robot accepts.
        first_foot: Foot that lands first; the other one supports.
        count: Footsteps.

    Returns:
        Footsteps in landing order, their times since the first was lifted.
    """
    speed = max(abs(velocity.forward), CREEPING)
    length, turn = (
        gait.path_interval * part for part in (speed, abs(velocity.turn))
    )
    share = 1.0 / max(1.0, length / limits.stride, turn / limits.turn)
    forward = velocity.forward >= 0.0
    path = UnicycleTrajectory(
        velocity.turn / gait.gain,
        speed,
        gait.gain,
        Direction.FORWARD if forward else Direction.BACKWARD,
    )
    rows = place_footsteps(
        path,
        count=count,
        stride=share * length,
        foot_spacing=gait.foot_spacing,
        first_foot=first_foot,
    )
    period = min(max(gait.step_duration, limits.shortest), limits.longest)
    support, foot = Pose(0.0, 0.0, 0.0), first_foot
    steps = []
    for number, row in enumerate(rows.tolist(), start=1):
        landed = Pose(*row)
        pose = support.inverse().compose(landed)
        steps.append(FootCommand(foot, pose, number * period))
        support, foot = landed, foot.other
    return tuple(steps)


def stride_of(pose: Pose, foot: Foot, foot_spacing: float) -> PathSegment:
    """Part of a path beside which a foot lands, an arc of a circle.

    Args:
        pose: Where it lands, in the frame of the other foot.
        foot: Side of the foot that lands.
        foot_spacing: Coronal distance between the feet, in [m].
    """
    feet = np.array([(0.0, 0.0, 0.0), pose])
    start, end = path_samples(feet, foot.other, foot_spacing).tolist()
    way = Pose(*start).inverse().compose(Pose(*end))
    half = 0.5 * way.theta  # an arc lies aside of its tangent by that much
    along = cos(half) * way.x + sin(half) * way.y
    aside = cos(half) * way.y - sin(half) * way.x
    # sin(a) / a, without dividing by a
    return PathSegment(along / float(np.sinc(half / np.pi)), way.theta, aside)
