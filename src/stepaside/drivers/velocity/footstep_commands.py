"""Footstep commands for a robot with its own walking control.

Each footstep is given relative to the other foot, as in NAOqi.
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

MIN_SPEED = 1e-6  # speed of a template that turns in place, in [m/s]


class FootCommand(NamedTuple):
    """Placement of one foot.

    Attributes:
        foot: Foot that lands.
        pose: Landing pose in the frame of the stance foot, in [m] and [rad].
        time: Landing time, in [s].
    """

    foot: Foot
    pose: Pose
    time: float


class PathSegment(NamedTuple):
    """Displacement of the template over one step.

    Attributes:
        length: Length along the path, in [m], negative backward.
        turn: Change of heading, in [rad].
        lateral: Lateral displacement, in [m], positive leftward; zero on
            any path of a unicycle.
    """

    length: float
    turn: float
    lateral: float


@dataclass(frozen=True, slots=True)
class StepLimits:
    """Limits of one step of a robot's own walking control.

    The defaults are the vendor's published values of NAO's default gait.

    Attributes:
        stride: Maximum displacement along the path, in [m].
        turn: Maximum change of heading, in [rad].
        shortest: Minimum step duration, in [s].
        longest: Maximum step duration, in [s].
    """

    stride: float = 0.04
    turn: float = 0.349
    shortest: float = 0.42
    longest: float = 0.6

    def __post_init__(self) -> None:
        """Validate the limits."""
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
    r"""Plan footsteps along the template's path (paper, Sec. III-C).

    The template starts beside the stance foot, on the path of eqs. (9) to
    (14) with the given turning rate; feet land beside it. Steps that exceed
    a limit are shortened along the path, so that its curvature is kept.

    Args:
        velocity: Velocity of the template: :math:`\pm \bar{v}`, in [m/s],
            and :math:`k \theta^*`, in [rad/s]. Finite.
        gait: Gives stride, steering gain, foot spacing and step duration.
        limits: Limits of one step.
        first_foot: Foot that lands first; the other one is the stance foot.
        count: Number of footsteps.

    Returns:
        Footsteps in landing order, with times since the first lift-off.
    """
    speed = max(abs(velocity.forward), MIN_SPEED)
    length, turn = (
        gait.path_interval * part for part in (speed, abs(velocity.turn))
    )
    scale = 1.0 / max(1.0, length / limits.stride, turn / limits.turn)
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
        stride=scale * length,
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


def path_segment_of(
    pose: Pose, foot: Foot, foot_spacing: float
) -> PathSegment:
    """Return the circular arc that the template follows over one step.

    Args:
        pose: Landing pose in the frame of the other foot.
        foot: Side of the foot that lands.
        foot_spacing: Coronal distance between the feet, in [m].
    """
    feet = np.array([(0.0, 0.0, 0.0), pose])
    start, end = path_samples(feet, foot.other, foot_spacing).tolist()
    motion = Pose(*start).inverse().compose(Pose(*end))
    half = 0.5 * motion.theta  # angle between the tangent and the chord
    along = cos(half) * motion.x + sin(half) * motion.y
    lateral = cos(half) * motion.y - sin(half) * motion.x
    # sin(a) / a, without dividing by a
    length = along / float(np.sinc(half / np.pi))
    return PathSegment(length, motion.theta, lateral)
