"""What a published model is made of: legs, feet and soles, found in it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ..errors import ModelError
from ..poses import Array
from ..robots.overlaying import odd_couplings, strip
from ..robots.reading import read_model
from ..world.shapes import points_of

LEVEL = 0.8  # least share of an axis along the one it is taken for
TOES = 0.1  # of a foot's length: more ahead of the ankle than behind
FLAT = 0.012  # of the leg's length: what of a foot counts as its sole
# Height of an ankle over the sole and edges of the sole, as parts of a leg.
GUESS = (0.12, -0.12, 0.22, -0.09, 0.09)
Turn = tuple[float, float, float, float]
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


@dataclass(frozen=True, eq=False)
class Survey:
    """A published model without what stands around it, and its legs.

    Attributes:
        path: File of the model.
        model: The model, compiled.
        data: Its state in the zero posture, torso level at the origin.
        torso: Body that carries the free joint.
        legs: Left and right one.
        missing: Mesh files that are left out.
        turn: Quaternion of the published torso's axes in (forward, left,
            up).
    """

    path: Path
    model: mujoco.MjModel
    data: mujoco.MjData
    torso: str
    legs: tuple[Leg, Leg]
    missing: tuple[str, ...]
    turn: Turn = (1.0, 0.0, 0.0, 0.0)

    @property
    def mass(self) -> float:
        """Mass of the robot, in [kg]."""
        return float(self.model.body_mass.sum())

    @property
    def length(self) -> float:
        """Length of a leg from its hip to the sole, in [m]."""
        return float(np.mean([leg.hip[2] - leg.sole for leg in self.legs]))

    @property
    def joints(self) -> list[str]:
        """Joints of the robot, in their order."""
        model = self.model
        return [
            model.joint(i).name
            for i in range(model.njnt)
            if model.jnt_type[i] in MOVES
        ]

    def turn_of(self, body: str) -> Array:
        """Quaternion of the torso's axes in a body. Shape (4,)."""
        turn = np.zeros(4)
        mujoco.mju_negQuat(turn, self.data.body(body).xquat)
        return turn

    def place_in(self, body: str, point: Array) -> Array:
        """A point in the frame of a body, in [m]. Shape (3,)."""
        found = self.data.body(body)
        place: Array = found.xmat.reshape(3, 3).T @ (point - found.xpos)
        return place


def survey(path: Path, folders: Sequence[Path]) -> Survey:
    """Look for legs and feet in a published model.

    Args:
        path: MJCF or URDF file.
        folders: Where meshes are looked for besides where it says.

    Raises:
        ModelError: If it is no model, or not one of a humanoid; says what
            is missing.
    """
    try:
        spec = read_model(path)
        torso = _root_of(spec, path)
        odd = {
            n for each in odd_couplings(spec) for n in (each.name1, each.name2)
        }
        missing = strip(spec, torso, path, list(folders))
        model = spec.compile()
    except ValueError as error:
        if isinstance(error, ModelError):
            raise
        raise ModelError(f"{path} cannot be compiled: {error}") from error
    data, turn, legs = _legs(model, path)
    for name in (*legs[0].joints, *legs[1].joints):
        if name in odd:
            raise ModelError(
                f"leg joint {name!r} of {path} follows another by more than "
                "polycoef 0 1 0 0 0, which the legs' kinematics does not know"
            )
    return Survey(path, model, data, torso, legs, tuple(missing), turn)


def _legs(
    model: mujoco.MjModel, path: Path
) -> tuple[mujoco.MjData, Turn, tuple[Leg, Leg]]:
    """Legs of a robot that is turned until it looks ahead.

    Raises:
        ModelError: If it has none whichever way it is turned; as it is found
            in the torso's own axes.
    """
    refused = None
    for quarters in (0, 2, 1, 3):
        half = 0.25 * np.pi * quarters
        turn = (float(np.cos(half)), 0.0, 0.0, float(np.sin(half)))
        data = mujoco.MjData(model)
        data.qpos[:7] = (0.0, 0.0, 0.0, *turn)
        mujoco.mj_forward(model, data)
        try:
            legs = _both_legs(model, data, path)
        except ModelError as error:
            refused = refused or error
            continue
        if sum(_looks_ahead(model, leg) for leg in legs) >= 0.0:
            return data, turn, legs
        refused = refused or ModelError(f"{path} looks nowhere")
    assert refused is not None
    raise refused


def _looks_ahead(model: mujoco.MjModel, leg: Leg) -> float:
    """1 if toes, or else the knee, say that forward is ahead, -1 if not."""
    back, front, *_ = leg.outline
    if not leg.is_guessed and abs(front + back) > TOES * (front - back):
        return float(np.sign(front + back))
    low, high = leg.signs[1] * model.joint(leg.pitches[1]).range
    return float(np.sign(round(low + high, 3)))


def _both_legs(
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


def _root_of(spec: Any, path: Path) -> str:
    """Body of the world that most bodies hang on: the robot."""
    roots = list(spec.worldbody.bodies)
    if not roots:
        raise ModelError(f"{path} has no body")
    root = max(roots, key=lambda body: len(body.find_all("body")))
    return str(root.name)


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
