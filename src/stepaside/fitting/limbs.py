"""Legs of a published model that stands as it is seen."""

from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from ..errors import ModelError
from ..poses import Array
from ..world.shapes import points_of

LEVEL = 0.8  # least share of an axis along the one it is taken for
FLAT = 0.012  # of the leg's length: what of a foot counts as its sole
# Height of an ankle over the sole and edges of the sole, as parts of a leg.
GUESS = (0.12, -0.12, 0.22, -0.09, 0.09)
MOVES = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


class Leg(NamedTuple):
    """One leg in the zero posture, seen from the torso.

    Attributes:
        joints: Between torso and foot.
        pitches: Those that bend it forward and back: hip, knee, ankle.
        signs: Sign of each pitch about the axis to the left.
        foot: Body of the foot.
        hip: Middle of its first three joints, in [m]. Shape (3,).
        ankle: Place of its last joint, in [m]. Shape (3,).
        sole: Height of the sole, in [m].
        outline: Edges of the sole from the ankle, in [m]: back, front,
            right, left.
        is_guessed: Whether sole and outline are a guess, for the foot has no
            geoms that say.
    """

    joints: tuple[str, ...]
    pitches: tuple[str, ...]
    signs: tuple[float, ...]
    foot: str
    hip: Array
    ankle: Array
    sole: float
    outline: tuple[float, float, float, float]
    is_guessed: bool = False


def find_legs(
    model: mujoco.MjModel, data: mujoco.MjData, path: Path
) -> tuple[Leg, Leg]:
    """Left and right leg of a robot that stands as it is seen.

    Raises:
        ModelError: If there are no two; says what is missing.
    """
    ends = [_end(model, data, body) for body in _ends(model)]
    feet = [
        min((e for e in ends if side * e.y > 0.0), key=lambda e: e.low)
        for side in (1.0, -1.0)
        if any(side * e.y > 0.0 for e in ends)
    ]
    if len(feet) < 2:
        raise ModelError(
            f"{path} has no two legs: of {len(ends)} chains of joints none "
            "ends to the left of the torso's origin and one to the right; "
            "the torso's z axis must point up, and its x or y axis forward"
        )
    chains = [_chain(model, end.body) for end in feet]
    own = [
        [j for j in chain if j not in chains[1 - side]]
        for side, chain in enumerate(chains)
    ]
    left, right = (
        _leg(model, data, end.body, chain)
        for end, chain in zip(feet, own, strict=True)
    )
    return left, right


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


def _rigid(model: mujoco.MjModel, body: int) -> list[int]:
    """A body and all that hangs on it."""
    found = [body]
    for other in range(body + 1, model.nbody):
        if int(model.body_parentid[other]) in found:
            found.append(other)
    return found


def _end(model: mujoco.MjModel, data: mujoco.MjData, body: int) -> _End:
    points = _foot_points(model, data, body)
    return _End(body, float(points[:, 2].min()), float(data.xpos[body, 1]))


def _foot_points(
    model: mujoco.MjModel, data: mujoco.MjData, body: int
) -> Array:
    """Points on the surface of an end, those that collide if any do."""
    geoms = [
        geom
        for part in _rigid(model, body)
        for geom in range(
            model.body_geomadr[part],
            model.body_geomadr[part] + model.body_geomnum[part],
        )
    ]
    touching = [
        geom
        for geom in geoms
        if model.geom_contype[geom] or model.geom_conaffinity[geom]
    ]
    found = [points_of(model, data, geom) for geom in touching or geoms]
    found = [points for points in found if len(points)]
    if not found:
        return np.array([data.xpos[body]])
    return np.concatenate(found)


def _chain(model: mujoco.MjModel, body: int) -> list[int]:
    """Joints from the torso to a body, in this order."""
    chain: list[int] = []
    while body:
        first = int(model.body_jntadr[body])
        own = range(first, first + int(model.body_jntnum[body]))
        chain = [j for j in own if model.jnt_type[j] in MOVES] + chain
        body = int(model.body_parentid[body])
    return chain


def _leg(
    model: mujoco.MjModel, data: mujoco.MjData, body: int, chain: list[int]
) -> Leg:
    """Joints that a leg has to itself, and its sole."""
    name = model.body(body).name
    pitches = [j for j in chain if abs(data.xaxis[j, 1]) > LEVEL]
    if len(pitches) != 3 or len(chain) < 5:
        raise ModelError(
            f"the leg that ends in {name!r} must have a pitch joint at hip, "
            f"knee and ankle, got {len(chain)} joints of which {len(pitches)} "
            "turn about the axis to the left"
        )
    ankle = data.xanchor[chain[-1]].copy()
    hip = data.xanchor[chain[:3]].mean(axis=0)
    points = _foot_points(model, data, body)
    low = float(points[:, 2].min())
    flat = points[points[:, 2] < low + FLAT * (hip[2] - low)]
    (back, right), (front, left) = (
        flat[:, :2].min(axis=0),
        flat[:, :2].max(axis=0),
    )
    outline = (
        float(back - ankle[0]),
        float(front - ankle[0]),
        float(right - ankle[1]),
        float(left - ankle[1]),
    )
    guessed = len(points) == 1
    if guessed:
        length = float(hip[2] - ankle[2])
        low = float(ankle[2]) - GUESS[0] * length
        back, front, right, left = (x * length for x in GUESS[1:])
        outline = back, front, right, left
    elif not (outline[0] < 0.0 < outline[1] and outline[2] < 0.0 < outline[3]):
        raise ModelError(
            f"the sole of {name!r} must lie under its ankle, got edges "
            f"{', '.join(f'{edge:.3f}' for edge in outline)} [m] from it: "
            "its geoms say nothing of a flat sole in the zero posture"
        )
    return Leg(
        tuple(model.joint(j).name for j in chain),
        tuple(model.joint(j).name for j in pitches),
        tuple(float(np.sign(data.xaxis[j, 1])) for j in pitches),
        name,
        hip,
        ankle,
        low,
        outline,
        guessed,
    )
