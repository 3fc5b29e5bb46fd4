"""Step in progress, and the ZMP shifts and landings that it allows."""

from math import cos, exp, hypot, sin
from typing import NamedTuple

from ...core.poses import Pose
from ...planning import Foot, GaitSettings, ManeuverPlan
from ...planning.schedule import swing_progress
from ...robots.leg_kinematics import BodyReference
from ..control_settings import StabiliserSettings

Box = tuple[tuple[float, float], tuple[float, float]]


class CurrentStep(NamedTuple):
    """Step in progress, in odometry."""

    support: Pose  # pose of the support foot
    swing: Foot  # foot that swings, or swung last
    landing: Pose  # planned landing pose
    remaining: float  # time until the landing [s]; negative after it
    progress: float  # fraction of the swing path that is completed
    walking: bool  # whether the robot walks; otherwise it stands
    plan: ManeuverPlan | None = None  # plan whose first step this is, if any
    passed: float = 0.0  # time since that plan began [s]

    def to_support(self, x: float, y: float) -> tuple[float, float]:
        """Rotate a vector from odometry to the support foot's axes."""
        c, s = cos(-self.support.theta), sin(-self.support.theta)
        return c * x - s * y, s * x + c * y

    def from_support(self, x: float, y: float) -> tuple[float, float]:
        """Rotate a vector from the support foot's axes to odometry."""
        c, s = cos(self.support.theta), sin(self.support.theta)
        return c * x - s * y, s * x + c * y


def resting_step(support: Pose, foot: Foot) -> CurrentStep:
    """Return the step of a robot that stands on a support, not on a foot."""
    return CurrentStep(support, foot, support, 0.0, 1.0, False)


def first_step_of(
    plan: ManeuverPlan,
    frame: Pose,
    passed: float,
    landing: Pose | None = None,
) -> CurrentStep:
    """Return the first step of a plan with a frame in odometry.

    The planned landing is given if it is known.
    """
    gait = plan.schedule.settings
    walked = passed
    if plan.schedule.standing:
        walked -= gait.start_support
    return CurrentStep(
        frame,
        plan.first_foot,
        frame.compose(plan.landing) if landing is None else landing,
        gait.single_support - walked,
        swing_progress(walked / gait.single_support, gait.swing_profile),
        True,
        plan,
        passed,
    )


def zmp_box(swing: Foot, gait: GaitSettings, edge: float) -> Box:
    """Return the range of ZMP shifts from the anchor under a foot.

    It is in the support foot's axes, and leaves the edge of the sole, in [m].
    """
    sole, ahead = gait.sole, gait.zmp_forward
    outer, inner = sole.outer - edge, sole.inner - edge
    right, left = (inner, outer) if swing is Foot.RIGHT else (outer, inner)
    return (
        (sole.back + edge - ahead, -right),
        (sole.front - edge - ahead, left),
    )


def clip_to(value: tuple[float, float], box: Box) -> tuple[float, float]:
    """Return the nearest point of a box."""
    low, high = box
    return (
        min(max(value[0], low[0]), high[0]),
        min(max(value[1], low[1]), high[1]),
    )


def beyond(x: float, y: float, radius: float) -> tuple[float, float]:
    """Return the part of a vector beyond a radius, in the same frame."""
    length = hypot(x, y)
    if length <= radius:
        return 0.0, 0.0
    share = 1.0 - radius / length
    return share * x, share * y


def adapted_landing(
    error: tuple[float, float],
    step: CurrentStep,
    box: Box,
    gait: GaitSettings,
    settings: StabiliserSettings,
) -> tuple[float, float]:
    r"""Return the shift of the landing for the DCM error beyond the ZMP range.

    A DCM error e that a constant ZMP shift p cannot bring to zero by the
    landing, a time T away, leaves
    :math:`e^{\eta T} (e - (1 - e^{-\eta T})\, p)`; the landing shifts by that
    much, within reach and without crossing the other foot.

    The error is in the support foot's axes, the shift in odometry, in [m].
    """
    grow = exp(gait.eta * max(step.remaining, 1e-3))
    hold = 1.0 - 1.0 / grow
    px, py = clip_to((error[0] / hold, error[1] / hold), box)
    planned = step.support.inverse().compose(step.landing)
    x, y, side = planned.x, planned.y, step.swing.value
    left_x = grow * (error[0] - hold * px)
    left_y = grow * (error[1] - hold * py)
    if abs(left_x) > 1e-9:
        low, high = -settings.reach_backward, settings.reach_forward
        x = min(max(x + left_x, low), high)
    if abs(left_y) > 1e-9:
        near = 2.0 * gait.sole.inner + settings.gap
        far = gait.foot_spacing + settings.reach_outward
        y = side * min(max(side * (y + left_y), near), far)
    return step.from_support(x - planned.x, y - planned.y)


def shifted_swing(
    body: BodyReference, step: CurrentStep, shift: tuple[float, float]
) -> BodyReference:
    """Return a reference whose swing foot heads for a shifted landing."""
    if not step.walking or shift == (0.0, 0.0):
        return body
    u, v = step.progress * shift[0], step.progress * shift[1]
    return moved_swing(body, step.swing, u, v, 0.0)


def moved_swing(
    body: BodyReference, swing: Foot, x: float, y: float, turn: float
) -> BodyReference:
    """Return a reference whose swing foot is moved in odometry."""
    left = swing is Foot.LEFT
    u, v, z, yaw = body.left_foot if left else body.right_foot
    moved = u + x, v + y, z, yaw + turn
    if left:
        return body._replace(left_foot=moved)
    return body._replace(right_foot=moved)
