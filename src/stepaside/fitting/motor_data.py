"""Torques, speeds and servo gains of a published model's joints."""

import re
from collections.abc import Container, Mapping
from pathlib import Path

import mujoco
import numpy as np

from ..core.constants import GRAVITY
from ..core.errors import ModelError
from ..robots.description_types import ServoGains
from .gait_feasibility import rounded
from .model_analysis import ModelAnalysis

# Leg joints: stiffness by the toppling stiffness m g z of the pendulum,
# damping by its time constant, armature by m z^2; the values of NAO's model.
STIFFNESS = 12.0
DAMPING_TIME = 0.3
ARMATURE = 0.004
# A saturated servo holds nothing. If a step takes more than WEAK_LOAD of a
# torque limit most of the time, servos are softened to saturate at no less
# than this error, in [rad], so that a foot that lands a little off does not
# saturate them; but no softer than LEAST_STIFFNESS m g z.
WEAK_LOAD = 0.6
SATURATION_ANGLE = 0.04
LEAST_STIFFNESS = 3.0
HEAVY = 0.2  # mass fraction from which a joint is as stiff as legs: waists
ARM_STIFFNESS = 15.0  # of other joints, by the gravity torque of their load
DEFAULT_TORQUE = 1.5  # unpublished torque limit, by m g z
IMPLAUSIBLE_TORQUE = 10.0  # by m g times the length of the legs
IMPLAUSIBLE_SPEED = 100.0  # in [rad/s]
DEFAULT_SPEED = 12.0  # unpublished speed limit, in [rad/s]
KEYS = "knees_bent", "stand", "standing", "home"  # of a standing robot
NAME = re.compile(r"""\bname\s*=\s*["']([^"']*)["']""")
# MuJoCo takes limits of 0 for none.
ZERO = r"""\b%s\s*=\s*["'][-+0. ]*["']"""
FIXED = re.compile(
    r"""\btype\s*=\s*["'](?:revolute|prismatic)["'].*<limit\b"""
    rf"(?=[^>]*{ZERO % 'lower'})(?=[^>]*{ZERO % 'upper'})",
    re.DOTALL,
)
SPEED = re.compile(r"""\bvelocity\s*=\s*["']\s*(\d+\.?\d*|\.\d+)\s*["']""")


def published_torques(spec: mujoco.MjSpec) -> dict[str, float]:
    """Return the torque limits in a model, by joint, in [N m].

    From the force range of the actuators, the control range of motors, or
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


def published_values(spec: mujoco.MjSpec) -> dict[str, dict[str, float]]:
    """Return the gains and the posture in a model, by joint.

    ``stiffness`` and ``damping`` of its position actuators, and
    ``default_posture`` of its keyframe of a standing robot, else of its first.
    """
    passive = {x.name: float(np.ravel(x.damping)[0]) for x in spec.joints}
    found: dict[str, dict[str, float]] = {
        "stiffness": {},
        "damping": {},
        "default_posture": {},
    }
    for actuator in spec.actuators:
        gain, bias = float(actuator.gainprm[0]), actuator.biasprm
        if gain > 0.0 and float(bias[1]) == -gain:
            name = actuator.target
            own = passive.get(name, 0.0) if name else 0.0
            found["stiffness"][name] = round(gain, 6)
            found["damping"][name] = round(own - float(bias[2]), 6)
    keys = {key.name: key.qpos for key in spec.keys if len(key.qpos)}
    chosen = next((k for k in (*KEYS, *keys) if k in keys), None)
    kinds, at = mujoco.mjtJoint, 0
    for joint in spec.joints if chosen is not None else ():
        if joint.type in (kinds.mjJNT_HINGE, kinds.mjJNT_SLIDE):
            angle = round(float(keys[chosen][at]), 6)
            found["default_posture"][joint.name] = angle
        at += {kinds.mjJNT_FREE: 7, kinds.mjJNT_BALL: 4}.get(joint.type, 1)
    return {name: table for name, table in found.items() if table}


def plausible_torques(
    torques: Mapping[str, float], mass: float, length: float
) -> dict[str, float]:
    """Return the torque limits without placeholders like 1e6."""
    greatest = IMPLAUSIBLE_TORQUE * mass * GRAVITY * length
    return {name: high for name, high in torques.items() if high < greatest}


def published_speeds(path: Path, legs: Container[str]) -> dict[str, float]:
    """Return the plausible speed limits in a URDF, by joint, in [rad/s].

    MuJoCo reads more than XML allows, so the file is not parsed as XML.

    Raises:
        ModelError: If a leg joint has the limits 0 and 0.
    """
    text = path.read_text(encoding="utf-8", errors="replace")
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    found = {}
    for joint in re.findall(r"<joint\b[^>]*[^/]>.*?</joint>", text, re.DOTALL):
        name, speed = NAME.search(joint), SPEED.search(joint)
        if name and name[1] in legs and FIXED.search(joint):
            raise ModelError(
                f"{path}: the upper limit of {name[1]!r} must be above the "
                "lower one, got 0 to 0"
            )
        if name and speed and 0.0 < float(speed[1]) < IMPLAUSIBLE_SPEED:
            found[name[1]] = float(speed[1])
    return found


def gains_of(
    found: ModelAnalysis,
    torques: dict[str, float],
    com_height: float,
    *,
    weak: bool = False,
) -> dict[str, ServoGains]:
    """Return the servo of every joint that does not follow another."""
    tipping = found.mass * GRAVITY * com_height
    time = np.sqrt(com_height / GRAVITY)
    legs = {name for leg in found.legs for name in leg.joints}
    gains, model = {}, found.model
    for name in found.joints:
        if name in followers_of(found.model):
            continue
        joint, torque = model.joint(name), torques.get(name)
        body = int(joint.bodyid[0])
        mass = float(model.body_subtreemass[body])
        arm = found.data.subtree_com[body] - found.data.xanchor[joint.id]
        lever = float(np.linalg.norm(arm))
        carried = float(model.body_inertia[body].max()) + mass * lever**2
        if name in legs or mass > HEAVY * found.mass:
            stiffness = STIFFNESS * tipping
            if weak and torque is not None:
                soft = max(
                    torque / SATURATION_ANGLE, LEAST_STIFFNESS * tipping
                )
                stiffness = min(stiffness, soft)
            inertia = ARMATURE * found.mass * com_height**2
        else:
            stiffness = (
                ARM_STIFFNESS * mass * GRAVITY * lever + 400.0 * carried
            )
            inertia = 0.1 * carried
        passive = float(joint.damping[0])
        damping = max(DAMPING_TIME * time * stiffness, passive)
        own = float(joint.armature[0])
        if torque is None:
            torque = DEFAULT_TORQUE * stiffness / STIFFNESS
        gains[name] = ServoGains(
            rounded(stiffness),
            rounded(damping),
            rounded(torque),
            0.0 if own > 0.2 * inertia else rounded(inertia),
        )
    return gains


def followers_of(model: mujoco.MjModel) -> set[str]:
    """Return the joints that an equality couples to a leader."""
    kind = int(mujoco.mjtEq.mjEQ_JOINT)
    return {
        model.joint(model.eq_obj1id[i]).name
        for i in range(model.neq)
        if model.eq_type[i] == kind and model.eq_obj2id[i] >= 0
    }
