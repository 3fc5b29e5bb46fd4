"""Legs of a published model that stands as it is seen."""

from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .sole_detection import foot_points, sole_of

LEVEL = 0.8  # least share of an axis along the one it is taken for
SLANTED = 0.5  # likewise of an axis that some other lies across
APART = 0.1  # of the leg: places of an ankle's axes that are far apart
MOVES = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


class NoLegsError(ModelError):
    """There are no two legs."""


class DetectedLeg(NamedTuple):
    """One leg in the zero posture, seen from the torso.

    Attributes:
        joints: Between torso and foot.
        pitches: Those that bend it forward and back: hip, knee, ankle.
        signs: Sign of each pitch about the axis to the left.
        foot: Body of the foot.
        hip: Middle of its first three joints, in [m]. Shape (3,).
        ankle: Place of its last joint, in [m]. Shape (3,).
        sole: Height of the sole, were it level, in [m].
        outline: Edges of the sole from the ankle, in [m]: back, front,
            right, left.
        is_guessed: Whether sole and outline are a guess, for the foot has no
            geoms that say.
        axes: Axes forward, left and up of the foot when it stands, as
            columns. Shape (3, 3).
        pivots: Places of the pitches, in [m]. Shape (3, 3).
    """

    joints: tuple[str, ...]
    pitches: tuple[str, ...]
    signs: tuple[float, ...]
    foot: str
    hip: Array
    ankle: Array
    sole: float
    outline: tuple[float, float, float, float]
    is_guessed: bool
    axes: Array
    pivots: Array


def find_legs(
    model: mujoco.MjModel, data: mujoco.MjData, path: Path
) -> tuple[DetectedLeg, DetectedLeg]:
    """Left and right leg of a robot that stands as it is seen.

    Raises:
        ModelError: If there are no two, or they are none to walk on; says
            what is missing.
    """
    ends = [_end(model, data, body) for body in _ends(model)]
    feet = [
        min((e for e in ends if side * e.y > 0.0), key=lambda e: e.low)
        for side in (1.0, -1.0)
        if any(side * e.y > 0.0 for e in ends)
    ]
    if len(feet) < 2:
        raise NoLegsError(f"{path} has no two legs: {_sides(ends)}")
    chains = [_chain(model, end.body) for end in feet]
    own = [
        [j for j in chain if j not in chains[1 - side]]
        for side, chain in enumerate(chains)
    ]
    left, right = (
        _leg(model, data, end.body, chain, side)
        for end, chain, side in zip(feet, own, ("left", "right"), strict=True)
    )
    return left, right


def _sides(ends: "list[_End]") -> str:
    """Where chains of joints end, in words."""
    if not ends:
        return (
            "no body below its torso has a hinge or a slide; the torso must "
            "be the body of the world that most bodies hang on"
        )
    left = sum(end.y > 0.0 for end in ends)
    right = sum(end.y < 0.0 for end in ends)
    return (
        f"each side must have a chain of joints that ends there, got {left} "
        f"to the left and {right} to the right of the torso's origin; the "
        "torso's z axis must point up, and its x or y axis forward"
    )


class _End(NamedTuple):
    body: int
    low: float
    y: float


def _ends(model: mujoco.MjModel) -> list[int]:
    """Bodies with joints, on which no others with joints hang."""
    jointed = [
        body
        for body in range(2, model.nbody)
        if any(
            model.jnt_type[j] in MOVES
            for j in range(
                model.body_jntadr[body],
                model.body_jntadr[body] + model.body_jntnum[body],
            )
        )
    ]
    above: set[int] = set()
    for body in jointed:
        parent = int(model.body_parentid[body])
        while parent:
            above.add(parent)
            parent = int(model.body_parentid[parent])
    return [body for body in jointed if body not in above]


def _end(model: mujoco.MjModel, data: mujoco.MjData, body: int) -> _End:
    points = foot_points(model, data, body)
    return _End(body, float(points[:, 2].min()), float(data.xpos[body, 1]))


def _chain(model: mujoco.MjModel, body: int) -> list[int]:
    """Joints from the torso to a body, in this order."""
    chain: list[int] = []
    while body:
        first = int(model.body_jntadr[body])
        own = range(first, first + int(model.body_jntnum[body]))
        chain = [j for j in own if model.jnt_type[j] in MOVES] + chain
        body = int(model.body_parentid[body])
    return chain


def _lacking(data: mujoco.MjData, chain: list[int], knee: int) -> list[str]:
    """Joints beside the pitches that a leg would need, in words."""
    upper = [j for j in chain if j < knee]
    lower = [j for j in chain if j > knee]
    wanted = (
        ("hip yaw", upper, 2),
        ("hip roll", upper, 0),
        ("ankle roll", lower, 0),
    )
    return [
        what
        for what, joints, axis in wanted
        if not any(abs(data.xaxis[j, axis]) > SLANTED for j in joints)
    ]


def _ankle(
    data: mujoco.MjData, chain: list[int], pitch: int, hip: Array
) -> Array:
    """Place of the last joint of a leg, in [m]. Shape (3,).

    Wherever along a roll axis a model says that it is, it is taken to be
    where the ankle's pitch crosses it, if they are far apart; and wherever
    along a pitch axis, where the ankle's roll does.
    """
    last = chain[-1]
    place: Array = data.xanchor[last].copy()
    axis = data.xaxis[last]
    if last == pitch:
        roll = chain[-2]
        if abs(data.xaxis[roll, 0]) < LEVEL:
            return place
        across: Array = data.xanchor[roll] - place
        crossing: Array = place + float(across @ axis) * axis
        return crossing
    along = float((data.xanchor[pitch] - place) @ axis)
    if abs(axis[0]) < LEVEL or abs(along) < APART * (hip - place)[2]:
        return place
    ankle: Array = place + along * axis
    return ankle


def _leg(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    body: int,
    chain: list[int],
    side: str,
) -> DetectedLeg:
    """Joints that a leg has to itself, and its sole."""
    pitches = [j for j in chain if abs(data.xaxis[j, 1]) > LEVEL]
    if len(pitches) == 4 and pitches[3] == chain[-1] and len(chain) > 6:
        # A toe: it stays, and what hangs on it is of the foot.
        chain, pitches = chain[:-1], pitches[:-1]
        body = int(model.jnt_bodyid[chain[-1]])
    name = model.body(body).name
    names = ", ".join(model.joint(j).name for j in chain)
    if len(pitches) != 3:
        raise ModelError(
            f"the lowest chain of joints on the {side} ends in {name!r} and "
            "is no leg: a leg must have a pitch joint at hip, knee and ankle, "
            f"got {len(chain)} joints of which {len(pitches)} turn about the "
            f"axis to the left: {names}"
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
