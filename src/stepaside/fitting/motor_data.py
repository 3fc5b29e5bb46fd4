"""Torques, speeds and servo gains of a published model's joints."""

from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from ..core.constants import GRAVITY
from ..robots.description_types import ServoGains
from .model_analysis import ModelAnalysis

# Gains and inertia of leg joints by what tips a robot: its weight times the
# length of its legs, and the pendulum's time; those of NAO's model.
STIFFNESS = 12.0
# A servo that is at its limit holds nothing. Of a robot whose joints bear
# more than that share of their torque in most of a step, servos get there at
# no less of an error than this, in [rad], so that a foot that lands a little
# off takes no torque from standing; none is softer than that part of what
# tips.
WEAK = 0.6
GIVES = 0.04
LEAST = 3.0
DAMPING_TIME = 0.3
ARMATURE = 0.004
HEAVY = 0.2  # of the mass: a waist that carries more is as stiff as legs
ARM = 15.0  # of the others, by the torque that holds what they carry
HOLDING = 1.5  # a torque that nobody tells, by the stiffest sensible one
NONSENSE = 10.0  # of a torque that no motor has, by what tips the robot
FASTEST = 100.0  # of a joint, in [rad/s]: a number for none
SPEED = 12.0  # of a joint, where nobody tells, in [rad/s]


def published_torques(spec: mujoco.MjSpec) -> dict[str, float]:
    """Greatest torque of each joint that a model tells, in [N m].

    From the force range of its actuators, the control range of motors, or
    the force range of the joint, in this order.
    """
    found: dict[str, float] = {}
    for joint in spec.joints:
        high = float(joint.actfrcrange[1])
        if high > 0.0 and joint.actfrclimited:
            found[joint.name] = high
    for actuator in spec.actuators:
        gear = abs(float(actuator.gear[0]))
        high = float(actuator.forcerange[1]) * gear
        is_motor = float(actuator.biasprm[1]) == 0.0
        if high <= 0.0 and is_motor:
            gain = abs(float(actuator.gainprm[0]))
            high = float(actuator.ctrlrange[1]) * gear * gain
        if high > 0.0:
            found[actuator.target] = high
    return found


def likely_torques(
    torques: Mapping[str, float], mass: float, length: float
) -> dict[str, float]:
    """Those torques that are no number for none.

    Args:
        torques: As a model tells them, in [N m].
        mass: Of the robot, in [kg].
        length: Of its legs, in [m].
    """
    most = NONSENSE * mass * GRAVITY * length
    return {name: high for name, high in torques.items() if high < most}


def published_speeds(path: Path) -> dict[str, float]:
    """Greatest speed of each joint that a URDF tells, in [rad/s]."""
    root = ElementTree.parse(path).getroot()
    if root.tag != "robot":
        return {}
    found = {}
    for joint in root.iter("joint"):
        limit = joint.find("limit")
        speed = 0.0 if limit is None else float(limit.get("velocity", 0.0))
        if 0.0 < speed < FASTEST:
            found[str(joint.get("name"))] = speed
    return found


def gains_of(
    found: ModelAnalysis,
    torques: dict[str, float],
    com_height: float,
    *,
    weak: bool = False,
) -> dict[str, ServoGains]:
    """Servo of every joint but the followers of others.

    Args:
        found: The model.
        torques: Greatest torques that are known, in [N m].
        com_height: Height of the CoM over the soles, in [m].
        weak: Whether walking asks for most of what the joints bear.
    """
    tipping = found.mass * GRAVITY * com_height
    time = np.sqrt(com_height / GRAVITY)
    legs = {name for leg in found.legs for name in leg.joints}
    gains = {}
    for name in found.joints:
        if name in followers_of(found.model):
            continue
        held = _held_by(found, name)
        torque = torques.get(name)
        if name in legs or held.mass > HEAVY * found.mass:
            stiffness = STIFFNESS * tipping
            if weak and torque is not None:
                soft = max(torque / GIVES, LEAST * tipping)
                stiffness = min(stiffness, soft)
            inertia = ARMATURE * found.mass * com_height**2
        else:
            stiffness = ARM * held.torque + 400.0 * held.inertia
            inertia = 0.1 * held.inertia
        passive = float(found.model.dof_damping[joint_of(found, name)])
        damping = max(DAMPING_TIME * time * stiffness, passive)
        own = float(found.model.joint(name).armature[0])
        if torque is None:
            torque = HOLDING * stiffness / STIFFNESS
        gains[name] = ServoGains(
            _short(stiffness),
            _short(damping),
            _short(torque),
            0.0 if own > 0.2 * inertia else _short(inertia),
        )
    return gains


def joint_of(found: ModelAnalysis, name: str) -> int:
    """Number of the velocity of a joint."""
    return int(found.model.joint(name).dofadr[0])


def followers_of(model: mujoco.MjModel) -> set[str]:
    """Joints that an equality lets follow another."""
    kind = int(mujoco.mjtEq.mjEQ_JOINT)
    return {
        model.joint(model.eq_obj1id[i]).name
        for i in range(model.neq)
        if model.eq_type[i] == kind and model.eq_obj2id[i] >= 0
    }


class _Held:
    """What a joint carries: its weight's torque at worst, its inertia."""

    def __init__(self, mass: float, lever: float, inertia: float) -> None:
        self.mass = mass
        self.torque = mass * GRAVITY * lever
        self.inertia = inertia + mass * lever**2


def _held_by(found: ModelAnalysis, name: str) -> _Held:
    model, data = found.model, found.data
    joint = model.joint(name)
    body = int(joint.bodyid[0])
    mass = float(model.body_subtreemass[body])
    lever = np.linalg.norm(data.subtree_com[body] - data.xanchor[joint.id])
    spread = float(model.body_inertia[body].max())
    return _Held(mass, float(lever), spread)


def _short(value: float) -> float:
    return float(f"{value:.3g}")
