"""Names of NAOqi's joints and kinematic chains."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from ...core.poses import Array

LEG = (
    "HipYawPitch",
    "HipRoll",
    "HipPitch",
    "KneePitch",
    "AnklePitch",
    "AnkleRoll",
)
ARM = (
    "ShoulderPitch",
    "ShoulderRoll",
    "ElbowYaw",
    "ElbowRoll",
    "WristYaw",
    "Hand",
)
SIMPLE = {
    "Head": ("HeadYaw", "HeadPitch"),
    "LArm": tuple(f"L{joint}" for joint in ARM),
    "LLeg": tuple(f"L{joint}" for joint in LEG),
    "RLeg": tuple(f"R{joint}" for joint in LEG),
    "RArm": tuple(f"R{joint}" for joint in ARM),
}
BODY = tuple(joint for joints in SIMPLE.values() for joint in joints)
LEGS = (*SIMPLE["LLeg"], *SIMPLE["RLeg"])
WHOLE = ("Body", "Joints", "Actuators", "JointActuators")
CHAINS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    SIMPLE
    | {"Legs": LEGS, "Arms": (*SIMPLE["LArm"], *SIMPLE["RArm"])}
    | dict.fromkeys(WHOLE, BODY)
)


def joints_of(names: Any, known: Sequence[str]) -> list[str]:
    """Expand names of joints and chains to joints, in NAOqi's order.

    Args:
        names: One name or several, each of a joint or of a chain.
        known: Joints of the robot. A chain for the whole body has all of
            them, joints that NAOqi does not define last.

    Raises:
        ValueError: If the robot has no such joint or chain.
    """
    found: list[str] = []
    for name in [names] if isinstance(names, str) else list(names):
        if name in known:
            found.append(name)
        elif isinstance(name, str) and name in CHAINS:
            chain = [joint for joint in CHAINS[name] if joint in known]
            if name in WHOLE:
                chain += [joint for joint in known if joint not in BODY]
            found += chain
        else:
            raise ValueError(
                f"there is no joint {name!r:.40}; joints are "
                f"{', '.join(known)}, chains {', '.join(CHAINS)}"
            )
    return found


def values_of(joints: Sequence[str], values: Any, what: str) -> Array:
    """Return one finite value for each joint.

    Args:
        joints: Names of the joints.
        values: One value for all joints, or one for each.
        what: Name of the values, for messages.

    Returns:
        Shape (joints,).

    Raises:
        ValueError: If their number does not match, or one is NaN or inf.
    """
    given = _one_each(joints, values)
    if not np.isfinite(given).all():
        raise ValueError(f"{what} must be finite, got {values!r:.80}")
    return given


def shares_of(joints: Sequence[str], values: Any) -> Array:
    """Return a stiffness for each joint, from 0 to 1.

    Args:
        joints: Names of the joints.
        values: One value for all joints, or one for each.

    Returns:
        Shape (joints,).

    Raises:
        ValueError: If their number does not match, or one is out of range.
    """
    given = _one_each(joints, values)
    if not np.all((given >= 0.0) & (given <= 1.0)):
        raise ValueError(f"stiffness must lie in [0, 1], got {values!r:.80}")
    return given


def _one_each(joints: Sequence[str], values: Any) -> Array:
    given = np.array(values, dtype=np.float64)
    if given.ndim > 1 or given.size not in (1, len(joints)):
        raise ValueError(
            f"{len(joints)} joints need one value, or {len(joints)}, got "
            f"{given.size}"
        )
    return np.broadcast_to(given.ravel(), len(joints)).copy()
