r"""Standing posture of a robot: knees slightly bent, arms hanging.

Hip, knee and ankle pitch have parallel lateral axes, so that a leg is a
planar two-link chain. The knee bends by :math:`\kappa` from the straight leg,
the hip puts the ankle under itself, and the ankle levels the foot. In the
zero posture of most models the leg is straight and the foot level; if not,
their angles are taken into account.
"""

from math import atan2, cos, sin

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..robots.geom_points import geom_points_in_world
from .model_analysis import ALIGNED, JOINT_TYPES, DetectedLeg, ModelAnalysis

BENT = (-0.3, 0.6, -0.3)  # hip, knee and ankle of a straight leg, in [rad]
STRAIGHT_MARGIN = 0.05  # least bend of a knee, in [rad]
STRAIGHT_TOLERANCE = 0.25  # smaller knee angles count as straight, in [rad]
RANGE_MARGIN = 0.02  # from the ends of a joint range, in [rad]
# Drop of the CoM of an arm, by the length of a leg, from which it is lowered.
LEAST_DROP = 0.1
ARM_CLEARANCE = 0.2  # angle of hanging arms from the vertical, in [rad]
REACH_MARGIN = 1.15  # factor on the measured reach


def standing_of(found: ModelAnalysis) -> dict[str, float]:
    """Return the standing angles that are not zero, by joint, in [rad]."""
    model = found.model
    angles = {
        name: _inside(model, name, bend)
        for leg in found.legs
        for name, bend in _bends(found, leg).items()
    }
    for name in _shoulders(found):
        angle = _hanging(found, name, angles)
        if angle != 0.0:
            angles[name] = angle
    for name in found.joints:  # zero may be outside a range
        if name not in angles and _inside(model, name, 0.0) != 0.0:
            angles[name] = _inside(model, name, 0.0)
    return {name: round(angle, 3) for name, angle in angles.items()}


def _bends(found: ModelAnalysis, leg: DetectedLeg) -> dict[str, float]:
    """Return the standing angles of the pitch joints of a leg, in [rad]."""
    bends = bend_of(leg, _range_of(found, leg.pitches[1]))
    return dict(zip(leg.pitches, bends, strict=True))


def _range_of(found: ModelAnalysis, name: str) -> tuple[float, float]:
    """Return the range of a joint, (-pi, pi) if unlimited, in [rad]."""
    low, high = found.model.joint(name).range.tolist()
    return (low, high) if low < high else (-np.pi, np.pi)


def knee_limits(found: ModelAnalysis, leg: DetectedLeg) -> tuple[float, float]:
    """Return the range of a knee without the straight leg, in [rad]."""
    name, sign = leg.pitches[1], leg.signs[1]
    low, high = least, most = _range_of(found, name)
    straight = straight_of(leg)
    bends = sign * _bends(found, leg)[name] - straight
    bent = sign * (straight + np.copysign(STRAIGHT_MARGIN, bends))
    if sign * bends > 0.0:
        low = max(low, bent)
    else:
        high = min(high, bent)
    if low >= high:
        raise ModelError(
            f"{found.path}: a knee must bend by more than {STRAIGHT_MARGIN:g} "
            f"rad, but the range of {name!r} is {least:.3g} to {most:.3g} rad "
            "(angles of an MJCF are in degrees unless its <compiler> has "
            'angle="radian")'
        )
    return round(low, 4), round(high, 4)


def reach_of(
    found: ModelAnalysis, standing: dict[str, float], forward: float
) -> float:
    """Return the radius around the reference point that contains it."""
    model, data = found.model, _posture(found, standing)
    mujoco.mj_kinematics(model, data)
    points = [
        geom_points_in_world(model, data, geom) for geom in range(model.ngeom)
    ]
    points.append(data.xpos[2:])  # for bodies without geoms
    away = np.concatenate([each[:, :2] for each in points if len(each)])
    farthest = np.linalg.norm(away - (forward, 0.0), axis=1).max(initial=0.0)
    return round(REACH_MARGIN * float(farthest), 3)


def _posture(found: ModelAnalysis, angles: dict[str, float]) -> mujoco.MjData:
    """Return the zero posture with other angles of some joints."""
    data = mujoco.MjData(found.model)
    data.qpos[:] = found.data.qpos
    for name, angle in angles.items():
        data.joint(name).qpos[0] = angle
    return data


def _inside(model: mujoco.MjModel, name: str, angle: float) -> float:
    """Clip an angle to the range of a joint."""
    joint = model.joint(name)
    if not model.jnt_limited[joint.id]:
        return angle
    low, high = joint.range.tolist()
    low, high = min(low + RANGE_MARGIN, 0.0), max(high - RANGE_MARGIN, 0.0)
    return float(min(max(angle, low), high))


def _shoulders(found: ModelAnalysis) -> list[str]:
    """Return the shoulder joints: roll and pitch nearest to the torso."""
    model, data = found.model, found.data
    legs = {name for leg in found.legs for name in leg.joints}
    arms: dict[tuple[float, int], str] = {}
    for j in range(model.njnt):
        name, aside = model.joint(j).name, float(data.xanchor[j, 1])
        axis = int(np.abs(data.xaxis[j]).argmax())
        if (
            model.jnt_type[j] in JOINT_TYPES
            and name not in legs
            and axis < 2
            and abs(data.xaxis[j, axis]) > ALIGNED
            and abs(aside) > 0.05 * found.length
        ):
            arms.setdefault((np.sign(aside), axis), name)
    return list(arms.values())


def _hanging(
    found: ModelAnalysis, name: str, known: dict[str, float]
) -> float:
    """Return the shoulder angle of a hanging arm, clear of the body."""
    model, data = found.model, _posture(found, known)
    joint = model.joint(name)
    body = int(joint.bodyid[0])
    low, high = joint.range.tolist()
    if not model.jnt_limited[joint.id]:
        low, high = -np.pi / 2, np.pi / 2
    angles = np.arange(low + RANGE_MARGIN, high - RANGE_MARGIN, 0.05)
    heights = []
    for angle in angles:
        data.joint(name).qpos[0] = angle
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        heights.append(float(data.subtree_com[body, 2]))
    if not heights:
        return 0.0
    best = float(angles[int(np.argmin(heights))])
    zero = heights[int(np.abs(angles).argmin())]
    if zero - min(heights) < LEAST_DROP * found.length:
        return 0.0
    # Outward: the direction that moves the arm to its own side.
    side = float(np.sign(data.xanchor[joint.id, 1]))
    outward = side * float(np.sign(found.data.xaxis[joint.id, 0]))
    if abs(found.data.xaxis[joint.id, 0]) > ALIGNED:
        best += ARM_CLEARANCE * outward
    return _inside(model, name, best)


def bend_of(leg: DetectedLeg, knee_range: tuple[float, float]) -> list[float]:
    """Return the standing angles of hip, knee and ankle, in [rad].

    They are signed by the joint axes of the model.
    """
    hip, knee, ankle = BENT
    straight = straight_of(leg)
    x, _, z = leg.axes[:, 0]
    tilt = atan2(-z, x) if z else 0.0  # of the sole, about the left axis
    if straight or tilt:
        low, high = sorted(leg.signs[1] * end for end in knee_range)
        forward = min(straight + knee, high) - straight
        backward = straight - max(straight - knee, low)
        knee = straight + (knee if forward >= backward else -knee)
        upper, lower = _rods(leg)
        x = upper[0] + lower[0] * cos(knee) + lower[1] * sin(knee)
        z = upper[1] - lower[0] * sin(knee) + lower[1] * cos(knee)
        hip = atan2(x, -z)
        ankle = -tilt - hip - knee
    angles = (hip, knee, ankle)
    return [s * angle for s, angle in zip(leg.signs, angles, strict=True)]


def straight_of(leg: DetectedLeg) -> float:
    """Return the knee angle of the straight leg, about the left axis.

    In [rad]; 0 if the leg is about straight in the zero posture.
    """
    upper, lower = (atan2(x, -z) for x, z in _rods(leg))
    straight = lower - upper
    return straight if abs(straight) > STRAIGHT_TOLERANCE else 0.0


def _rods(leg: DetectedLeg) -> list[tuple[float, float]]:
    """Return thigh and shank vectors (forward, up), in [m]."""
    hip, knee, ankle = leg.pivots
    spans = (knee - hip, ankle - knee)
    return [(float(span[0]), float(span[2])) for span in spans]
