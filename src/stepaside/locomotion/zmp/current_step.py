"""ZMP shifts and landings that a step in progress allows."""

from math import exp, hypot

from ...planning import Foot, GaitSettings
from ...robots.leg_kinematics import BodyReference
from ..control_settings import StabiliserSettings
from ..locomotion import CurrentStep

Box = tuple[tuple[float, float], tuple[float, float]]


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
