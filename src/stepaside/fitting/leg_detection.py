"""Detection of the legs in a published model."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .sole_detection import foot_points, sole_of

ALIGNED = 0.8  # least direction cosine of a joint axis with its frame axis
INCLINED = 0.5  # likewise of an inclined joint axis
FAR_APART = 0.1  # distance of ankle axes beyond which one is moved, by leg
JOINT_TYPES = (
    int(mujoco.mjtJoint.mjJNT_HINGE),
    int(mujoco.mjtJoint.mjJNT_SLIDE),
)


class NoLegsError(ModelError):
    """The model does not have two legs."""


class DetectedLeg(NamedTuple):
    """One leg in the zero posture, in the torso frame."""

    joints: tuple[str, ...]  # joints between torso and foot
    pitches: tuple[str, ...]  # pitch joints of hip, knee and ankle
    # sign of each pitch axis along the axis to the left
    signs: tuple[float, ...]
    foot: str
    hip: Array  # mean position of the first three joints [m]. Shape (3,)
    ankle: Array  # position of the last joint [m]. Shape (3,)
    sole: float  # height of the sole of the levelled foot [m]
    # edges of the sole from the ankle [m]: back, front, right, left
    outline: tuple[float, float, float, float]
    # whether sole and outline are a guess, because the foot has no geoms
    is_guessed: bool
    # axes forward, left and up of the standing foot, as columns. Shape (3, 3)
    axes: Array
    pivots: Array  # positions of the pitch joints [m]. Shape (3, 3)


def find_legs(
    model: mujoco.MjModel, data: mujoco.MjData, path: Path
) -> tuple[DetectedLeg, DetectedLeg]:
    """Find the left and right leg of a robot."""
    ends = [
        _End(
            body,
            float(foot_points(model, data, body)[:, 2].min()),
            float(data.xpos[body, 1]),
        )
        for body in _ends(model)
    ]
    feet = [
        min((e for e in ends if side * e.y > 0.0), key=lambda e: e.low)
        for side in (1.0, -1.0)
        if any(side * e.y > 0.0 for e in ends)
    ]
    if len(feet) < 2:
        raise NoLegsError(
            f"{path} does not have two legs: {_sides(data, ends)}"
        )
    near, far = (_chain(model, end.body) for end in feet)
    shared = set(near) & set(far)
    left, right = (
        _leg(model, data, end.body, [j for j in chain if j not in shared], at)
        for end, chain, at in zip(
            feet, (near, far), ("left", "right"), strict=True
        )
    )
    return left, right


class _End(NamedTuple):
    """Body at the end of a chain, its lowest point and its side, in [m]."""

    body: int
    low: float
    y: float


def _sides(data: mujoco.MjData, ends: list[_End]) -> str:
    """Return the explanation of missing legs."""
    if not ends:
        return (
            "no body below its torso has a hinge or a slide; the torso must "
            "be the root body with the most descendants"
        )
    below = np.abs(data.xpos[[end.body for end in ends]].mean(axis=0))
    if below.argmax() != 2:
        return (
            f"it stands along the {'xy'[below.argmax()]} axis of its torso, "
            "whose z axis must point up"
        )
    left = sum(end.y > 0.0 for end in ends)
    right = sum(end.y < 0.0 for end in ends)
    return (
        f"each side must have a joint chain that ends there, got {left} to "
        f"the left and {right} to the right of the torso origin; the z axis "
        "of the torso must point up, and its x or y axis forward"
    )


def _above(model: mujoco.MjModel, body: int) -> Iterator[int]:
    """Yield the ancestors of a body."""
    while body := int(model.body_parentid[body]):
        yield body


def _ends(model: mujoco.MjModel) -> list[int]:
    """Return the bodies with joints that have no jointed descendants."""
    moving = np.isin(model.jnt_type, JOINT_TYPES) & (model.jnt_bodyid > 1)
    jointed = set(model.jnt_bodyid[moving].tolist())
    return sorted(jointed - {b for own in jointed for b in _above(model, own)})


def _chain(model: mujoco.MjModel, body: int) -> list[int]:
    """Return the joints from the torso to a body."""
    bodies = body, *_above(model, body)
    moving = np.isin(model.jnt_type, JOINT_TYPES)
    found: list[int] = np.flatnonzero(
        moving & np.isin(model.jnt_bodyid, bodies)
    ).tolist()
    return found


def _lacking(data: mujoco.MjData, chain: list[int], knee: int) -> list[str]:
    """Return the names of missing yaw and roll joints of a leg."""
    at = chain.index(knee)
    return [
        name
        for name, joints, axis in (
            ("hip yaw", chain[:at], 2),
            ("hip roll", chain[:at], 0),
            ("ankle roll", chain[at + 1 :], 0),
        )
        if not (np.abs(data.xaxis[joints, axis]) > INCLINED).any()
    ]


def _ankle(
    data: mujoco.MjData, chain: list[int], pitch: int, hip: Array
) -> Array:
    """Return the position of the ankle, in [m]. Shape (3,).

    The anchor of a joint may be anywhere along its axis. The ankle is the
    point of the last axis nearest to the other ankle axis; for a final roll
    joint, only if its anchor is far from there.
    """
    last = chain[-1]
    anchor: Array = data.xanchor[last].copy()
    axis = data.xaxis[last]
    if last == pitch:
        roll = chain[-2]
        if abs(data.xaxis[roll, 0]) < ALIGNED:
            return anchor
        across: Array = data.xanchor[roll] - anchor
        crossing: Array = anchor + float(across @ axis) * axis
        return crossing
    along = float((data.xanchor[pitch] - anchor) @ axis)
    if abs(axis[0]) < ALIGNED or abs(along) < FAR_APART * (hip - anchor)[2]:
        return anchor
    ankle: Array = anchor + along * axis
    return ankle


def _leg(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    body: int,
    chain: list[int],
    side: str,
) -> DetectedLeg:
    """Return a leg from its joint chain."""
    pitches = [j for j in chain if abs(data.xaxis[j, 1]) > ALIGNED]
    if len(pitches) == 4 and pitches[3] == chain[-1] and len(chain) > 6:
        # A toe joint: kept fixed, so that the toe is part of the foot.
        chain, pitches = chain[:-1], pitches[:-1]
        body = int(model.jnt_bodyid[chain[-1]])
    name = model.body(body).name
    names = ", ".join(model.joint(j).name for j in chain)
    if len(pitches) != 3:
        raise ModelError(
            f"no leg found on the {side}: the lowest chain of joints ends in "
            f"{name!r}; a leg must have a pitch joint at hip, knee and "
            f"ankle, got {len(chain)} joints of which {len(pitches)} turn "
            f"about the axis to the left: {names}"
        )
    lacking = _lacking(data, chain, pitches[1])
    if len(chain) < 6:
        raise ModelError(
            f"the lowest chain of joints on the {side} ends in {name!r} and "
            "must have at least 6 joints to place a foot, got "
            f"{len(chain)} and no "
            f"{' and no '.join(lacking) or 'other'}: {names}"
        )
    hip = data.xanchor[chain[:3]].mean(axis=0)
    ankle = _ankle(data, chain, pitches[2], hip)
    sole = sole_of(model, data, body, hip, ankle)
    return DetectedLeg(
        tuple(model.joint(j).name for j in chain),
        tuple(model.joint(j).name for j in pitches),
        tuple(float(np.sign(data.xaxis[j, 1])) for j in pitches),
        name,
        hip,
        ankle,
        float(ankle[2]) - sole.height,
        sole.outline,
        sole.is_guessed,
        sole.axes,
        data.xanchor[pitches].copy(),
    )
