"""What a published model is made of: legs, feet and soles, found in it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from ..robots.model_overlay import odd_couplings, strip
from ..robots.model_reader import read_model
from .leg_detection import MOVES, DetectedLeg, NoLegsError, find_legs

TOES = 0.1  # of a foot's length: more ahead of the ankle than behind
KNEES = 0.3  # what a knee that bends one way counts by the foot's length
Turn = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class ModelAnalysis:
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
    legs: tuple[DetectedLeg, DetectedLeg]
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


def survey(path: Path, folders: Sequence[Path]) -> ModelAnalysis:
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
        odd = [(each.name1, each.name2) for each in odd_couplings(spec)]
        missing = strip(spec, torso, path, list(folders))
        model = spec.compile()
    except ValueError as error:
        if isinstance(error, ModelError):
            raise
        raise ModelError(f"{path} cannot be compiled: {error}") from error
    data, turn, legs = _legs(model, path)
    of_legs = {*legs[0].joints, *legs[1].joints}
    for name, leader in odd:
        if name in of_legs and leader in of_legs:
            raise ModelError(
                f"leg joint {name!r} of {path} follows {leader!r} by more "
                "than polycoef 0 1 0 0 0, which the legs' kinematics does "
                "not know"
            )
    return ModelAnalysis(path, model, data, torso, legs, tuple(missing), turn)


def _legs(
    model: mujoco.MjModel, path: Path
) -> tuple[mujoco.MjData, Turn, tuple[DetectedLeg, DetectedLeg]]:
    """Legs of a robot that is turned until it looks ahead.

    Raises:
        ModelError: If it has none whichever way it is turned; as it is found
            in the torso's own axes.
    """
    refused: ModelError | None = None
    for quarters in (0, 2, 1, 3):
        half = 0.25 * np.pi * quarters
        turn = (float(np.cos(half)), 0.0, 0.0, float(np.sin(half)))
        data = mujoco.MjData(model)
        data.qpos[:7] = (0.0, 0.0, 0.0, *turn)
        mujoco.mj_forward(model, data)
        try:
            legs = find_legs(model, data, path)
        except NoLegsError as error:
            refused = refused or error
            continue
        except ModelError as error:  # of legs that are there: says more
            told = refused is None or isinstance(refused, NoLegsError)
            refused = error if told else refused
            continue
        if sum(_looks_ahead(model, leg) for leg in legs) >= 0.0:
            return data, turn, legs
        refused = refused or ModelError(f"{path} looks nowhere")
    assert refused is not None
    raise refused


def _looks_ahead(model: mujoco.MjModel, leg: DetectedLeg) -> float:
    """How much toes and knees say that forward is ahead; below 0 if not.

    Some feet are longer behind the ankle, some knees bend backward, none
    are known to do both.
    """
    back, front, *_ = leg.outline
    low, high = leg.signs[1] * model.joint(leg.pitches[1]).range
    bends = round(low + high, 3) / max(abs(high - low), 0.1)
    toes = (front + back) / (front - back)
    if leg.is_guessed or abs(toes) < TOES:
        toes = 0.0
    return float(toes + KNEES * bends)


def _root_of(spec: Any, path: Path) -> str:
    """Body of the world that most bodies hang on: the robot."""
    roots = list(spec.worldbody.bodies)
    if not roots:
        raise ModelError(f"{path} has no body")
    root = max(roots, key=lambda body: len(body.find_all("body")))
    return str(root.name)
