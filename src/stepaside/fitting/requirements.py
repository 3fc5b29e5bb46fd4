"""Static requirements of a robot for walking, checked one by one."""

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.errors import StepAsideError
from ..core.poses import Pose
from ..games.robot_settings import settings_from_description
from ..locomotion.zmp.reference_table import standing_reference
from ..robots.description import FILE, REMEDY, RobotDescription
from ..robots.forward_kinematics import ForwardKinematics
from ..robots.leg_kinematics import LegKinematics
from ..robots.tree_compiler import compile_tree
from .gait_feasibility import step_loads

GREATEST_FOOT_DIFFERENCE = 0.05  # from mirroring each other, by the CoM height
GREATEST_COM_OFFSET = 0.05  # lateral, by the CoM height
LEAST_REACH_MARGIN = 0.01  # of the CoM height, by the greatest in reach
GREATEST_LOAD = 0.95  # of a torque limit in a step
TICK = 0.004  # of the kinematics that stands, in [s]


class RequirementCheck(NamedTuple):
    """Result of one check.

    Attributes:
        name: Name of the requirement.
        verdict: "pass", "warn" or "fail".
        value: Measured value as text.
        hint: Remedy; empty if it passed.
    """

    name: str
    verdict: str
    value: str
    hint: str = ""


def check_requirements(
    description: RobotDescription,
) -> list[RequirementCheck]:
    """Check all requirements that need no walking.

    An invalid description ends the list with a failure that gives the
    reason.
    """
    results: list[RequirementCheck] = []
    for name, check in CHECKS.items():
        try:
            results += check(description)
        except StepAsideError as error:
            results.append(
                RequirementCheck(name, "fail", str(error), HINTS[name])
            )
            break
    return results


def _kinematics(description: RobotDescription) -> Iterator[RequirementCheck]:
    tree = compile_tree(description)
    description.check(tree.bodies, tree.sites, tree.joints, tree.motors)
    yield RequirementCheck("free joint", "pass", f"at {description.torso}")
    legs = len(description.legs)
    yield RequirementCheck(
        "joints", "pass", f"{len(tree.joints)}, of which {legs} in the legs"
    )


def _estimates(description: RobotDescription) -> Iterator[RequirementCheck]:
    """Name the tables that ``robot init`` marked as estimates."""
    text = (description.folder / FILE).read_text(encoding="utf-8-sig")
    tables = re.findall(r"ASK:.*?\n\[([\w.]+)\]", text, re.DOTALL)
    yield RequirementCheck(
        "estimates",
        "warn" if tables else "pass",
        ", ".join(tables) or "none",
        "replace values marked by ASK by measured ones" if tables else "",
    )


def _masses(description: RobotDescription) -> Iterator[RequirementCheck]:
    model = description.compile()
    total = float(model.body_mass.sum())
    names = [model.body(b).name for b in range(model.nbody)]
    empty = [
        names[b]
        for b in range(1, model.nbody)
        if model.body_jntnum[b] and model.body_subtreemass[b] <= 0.0
    ]
    yield RequirementCheck(
        "masses",
        "fail" if empty else "pass",
        f"{total:.2f} kg" + (f", none for {empty[0]}" if empty else ""),
        "give links an inertial" if empty else "",
    )
    forward = ForwardKinematics(description)
    angles = [
        description.standing.get(name, 0.0) for name in forward.tree.motors
    ]
    posture = forward.posture(np.array(angles, dtype=np.float64))
    aside = abs(
        float(
            posture.position_com_in_torso[1]
            - posture.positions_feet_in_torso[:, 1].mean()
        )
    )
    high = float(
        posture.position_com_in_torso[2]
        - posture.positions_feet_in_torso[:, 2].mean()
    )
    left, right = posture.positions_feet_in_torso
    apart = float(np.abs(left * (1.0, -1.0, 1.0) - right).max())
    mirrored = (
        aside < GREATEST_COM_OFFSET * high
        and apart < GREATEST_FOOT_DIFFERENCE * high
    )
    yield RequirementCheck(
        "mirror symmetry",
        "pass" if mirrored else "warn",
        f"CoM {1e3 * aside:.1f} mm off the middle of the feet, which are "
        f"{1e3 * apart:.1f} mm from mirroring each other",
        "" if mirrored else "see standing: angles of both sides must mirror",
    )


def _sensors(description: RobotDescription) -> Iterator[RequirementCheck]:
    model = description.compile()
    names = {model.sensor(i).name for i in range(model.nsensor)}
    own = description.sensors
    required = (own.gyro, own.accelerometer, *own.feet)
    missing = [name for name in required if name not in names]
    yield RequirementCheck(
        "sensors",
        "fail" if missing else "pass",
        f"no {', '.join(missing)}" if missing else "IMU, 4 under each foot",
        f"name them in [sensors]; {REMEDY}" if missing else "",
    )


def _actuators(description: RobotDescription) -> Iterator[RequirementCheck]:
    model = description.compile()
    free = [n for n in description.legs if n in description.speed_limits]
    by_joint = {
        model.joint(model.actuator_trnid[i, 0]).name: i
        for i in range(model.nu)
    }
    missing = [name for name in free if name not in by_joint]
    unlimited = [
        name
        for name, i in by_joint.items()
        if model.actuator_forcerange[i, 1] <= 0.0
    ]
    other = [
        name
        for name, i in by_joint.items()
        if model.actuator_biastype[i] != mujoco.mjtBias.mjBIAS_AFFINE
    ]
    faults = {
        "no actuator for": missing,
        "no force range for": unlimited,
        "no position servo for": other,
    }
    messages = [
        f"{text} {names[0]}" for text, names in faults.items() if names
    ]
    yield RequirementCheck(
        "actuators",
        "fail" if messages else "pass",
        "; ".join(messages) or f"{model.nu} servos with a force range",
        REMEDY if messages else "",
    )


def _reach(description: RobotDescription) -> Iterator[RequirementCheck]:
    gait = settings_from_description(description).gait
    half = 0.5 * gait.foot_spacing
    feet = Pose(0.0, half, 0.0), Pose(0.0, -half, 0.0)
    stance = standing_reference(*feet, gait)
    legs = LegKinematics(description, tick=TICK)
    legs.stand(stance)
    _, highest = legs.com_heights(stance)
    margin = highest - gait.com_height
    near = margin < LEAST_REACH_MARGIN * highest
    yield RequirementCheck(
        "reach",
        "warn" if near else "pass",
        f"CoM at {gait.com_height:.3f} of {highest:.3f} m",
        "lower gait.com_height: the knees get straight" if near else "",
    )


def _strength(description: RobotDescription) -> Iterator[RequirementCheck]:
    gait = settings_from_description(description).gait
    model = description.compile()
    torques = {
        model.joint(model.actuator_trnid[i, 0]).name: float(high)
        for i, high in enumerate(model.actuator_forcerange[:, 1])
    }
    loads = step_loads(description, gait, torques)
    weak = loads.usual > GREATEST_LOAD
    yield RequirementCheck(
        "torque of a step",
        "warn" if weak else "pass",
        f"{100.0 * loads.usual:.0f} % of the limit of {loads.joint}",
        f"see the torque limit of {loads.joint}: a step leaves no margin for "
        "feedback"
        if weak
        else "",
    )


CHECKS: dict[str, Callable[[RobotDescription], Iterator[RequirementCheck]]] = {
    "kinematics": _kinematics,
    "estimates": _estimates,
    "masses": _masses,
    "sensors": _sensors,
    "actuators": _actuators,
    "reach": _reach,
    "torque": _strength,
}
HINTS = {
    "kinematics": REMEDY,
    "estimates": "",
    "masses": "give links an inertial",
    "sensors": REMEDY,
    "actuators": REMEDY,
    "torque": "see [overlay.servos]",
    "reach": "change gait.com_height, foot_spacing or the standing angles",
}
