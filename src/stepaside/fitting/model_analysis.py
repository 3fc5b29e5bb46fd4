"""Analysis of a published model: torso, legs, feet and orientation."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..robots.model_overlay import scaled_couplings, strip
from ..robots.model_reader import read_model
from .leg_detection import JOINT_TYPES, DetectedLeg, NoLegsError, find_legs

LEAST_ASYMMETRY = 0.1  # of a sole about its ankle, by its length
KNEE_WEIGHT = 0.3  # of a knee that bends one way, by the asymmetry of a sole
WIDEST = 4.0 * np.pi  # range of a leg joint; a wider one is in [deg]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class ModelAnalysis:
    """The robot in a published model, and its legs."""

    path: Path  # file of the model
    model: mujoco.MjModel  # compiled model of the robot alone
    # zero posture, with the torso at the origin, facing forward
    data: mujoco.MjData
    torso: str  # body that carries the free joint
    legs: tuple[DetectedLeg, DetectedLeg]  # left and right leg
    missing: tuple[str, ...]  # mesh files that are missing or cannot be read
    # of the published torso in axes (forward, left, up)
    turn: Quaternion = (1.0, 0.0, 0.0, 0.0)

    @property
    def mass(self) -> float:
        """Mass of the robot, in [kg]."""
        return float(self.model.body_mass.sum())

    @property
    def length(self) -> float:
        """Mean length of the legs from hip to sole, in [m]."""
        return float(np.mean([leg.hip[2] - leg.sole for leg in self.legs]))

    @property
    def joints(self) -> list[str]:
        """Names of the hinges and slides of the robot."""
        model = self.model
        return [
            model.joint(i).name
            for i in range(model.njnt)
            if model.jnt_type[i] in JOINT_TYPES
        ]


def analyse_model(path: Path, folders: Sequence[Path]) -> ModelAnalysis:
    """Find torso, legs and feet in a published model."""
    try:
        spec = read_model(path)
        for body in spec.bodies:
            if body.mass < 0.0:
                raise ModelError(
                    f"{path}: the mass of {body.name!r} must be positive, got "
                    f"{body.mass:g} kg"
                )
        roots = list(spec.worldbody.bodies)
        if not roots:
            raise ModelError(f"{path} has no body")
        torso = max(roots, key=lambda body: len(body.find_all("body"))).name
        couplings = [
            (each.name1, each.name2) for each in scaled_couplings(spec)
        ]
        missing = strip(spec, torso, path, list(folders))
        model = spec.compile()
    except ValueError as error:
        if isinstance(error, ModelError):
            raise
        raise ModelError(f"{path} cannot be compiled: {error}") from error
    for i in range(model.njnt):
        if model.jnt_type[i] in JOINT_TYPES and not model.joint(i).name:
            body = model.body(int(model.jnt_bodyid[i])).name
            raise ModelError(f"{path}: the joint of {body!r} must have a name")
    data, turn, legs = _legs(model, path)
    leg_joints = {*legs[0].joints, *legs[1].joints}
    for name in sorted(leg_joints):
        low, high = model.joint(name).range
        if not low <= high < low + WIDEST:
            raise ModelError(
                f"{path}: the upper limit of {name!r} must be above the lower "
                f"one, both in rad, got {low:g} to {high:g}"
            )
    for name, leader in couplings:
        if name in leg_joints and leader in leg_joints:
            raise ModelError(
                f"leg joint {name!r} of {path} must follow {leader!r} with "
                "polycoef 0 1 0 0 0: inverse kinematics supports no other "
                "coupling"
            )
    return ModelAnalysis(path, model, data, torso, legs, tuple(missing), turn)


def _legs(
    model: mujoco.MjModel, path: Path
) -> tuple[mujoco.MjData, Quaternion, tuple[DetectedLeg, DetectedLeg]]:
    """Find the legs in the orientation in which the robot faces forward."""
    first_error: ModelError | None = None
    for quarters in (0, 2, 1, 3):
        half = 0.25 * np.pi * quarters
        turn = (float(np.cos(half)), 0.0, 0.0, float(np.sin(half)))
        data = mujoco.MjData(model)
        data.qpos[:7] = (0.0, 0.0, 0.0, *turn)
        mujoco.mj_forward(model, data)
        try:
            legs = find_legs(model, data, path)
        except NoLegsError as error:
            first_error = first_error or error
            continue
        except ModelError as error:  # more specific than missing legs
            if first_error is None or isinstance(first_error, NoLegsError):
                first_error = error
            continue
        if sum(forward_score(model, leg) for leg in legs) >= 0.0:
            return data, turn, legs
        first_error = first_error or ModelError(
            f"{path}: toes and knees do not tell which way the robot faces"
        )
    assert first_error is not None
    raise first_error


def forward_score(model: mujoco.MjModel, leg: DetectedLeg) -> float:
    """Score the evidence that a leg faces forward; negative for backward.

    Some feet are longer behind the ankle and some knees bend backward, but
    no published robot is known to have both.
    """
    back, front, *_ = leg.outline
    low, high = leg.signs[1] * model.joint(leg.pitches[1]).range
    bends = round(low + high, 3) / max(abs(high - low), 0.1)
    toes = (front + back) / (front - back)
    if leg.is_guessed or abs(toes) < LEAST_ASYMMETRY:
        toes = 0.0
    return float(toes + KNEE_WEIGHT * bends)
