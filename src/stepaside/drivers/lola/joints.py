"""The joints of a robot that speaks LoLA: order, ranges, speeds."""

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

import numpy as np

from ...errors import ModelError
from ...poses import Array


class LolaJoint(NamedTuple):
    """One of the 25 motors, in the order of every LoLA frame.

    Attributes:
        name: Its name. LHipYawPitch turns both hips: its motor is shared.
        low: Least angle, in [rad]; closed, for a hand, in [1].
        high: Greatest angle, in [rad]; open, for a hand, in [1].
        speed: No-load speed through the gear, in [rad/s].
    """

    name: str
    low: float
    high: float
    speed: float


# Facts that vendor and teams published; docs/nao.md names the sources.
LOLA_JOINTS = (
    LolaJoint("HeadYaw", -2.08567, 2.08567, 7.457),
    LolaJoint("HeadPitch", -0.671952, 0.514872, 6.469),
    LolaJoint("LShoulderPitch", -2.08567, 2.08567, 7.944),
    LolaJoint("LShoulderRoll", -0.314159, 1.32645, 6.469),
    LolaJoint("LElbowYaw", -2.08567, 2.08567, 7.457),
    LolaJoint("LElbowRoll", -1.54462, -0.0349066, 6.469),
    LolaJoint("LWristYaw", -1.82387, 1.82387, 17.381),
    LolaJoint("LHipYawPitch", -1.14529, 0.740718, 4.526),
    LolaJoint("LHipRoll", -0.379435, 0.79046, 4.526),
    LolaJoint("LHipPitch", -1.53589, 0.48398, 6.963),
    LolaJoint("LKneePitch", -0.0923279, 2.11255, 6.963),
    LolaJoint("LAnklePitch", -1.18944, 0.922581, 6.963),
    LolaJoint("LAnkleRoll", -0.397761, 0.768992, 4.526),
    LolaJoint("RHipRoll", -0.79046, 0.379435, 4.526),
    LolaJoint("RHipPitch", -1.53589, 0.48398, 6.963),
    LolaJoint("RKneePitch", -0.0923279, 2.11255, 6.963),
    LolaJoint("RAnklePitch", -1.1863, 0.932006, 6.963),
    LolaJoint("RAnkleRoll", -0.768992, 0.397761, 4.526),
    LolaJoint("RShoulderPitch", -2.08567, 2.08567, 7.944),
    LolaJoint("RShoulderRoll", -1.32645, 0.314159, 6.469),
    LolaJoint("RElbowYaw", -2.08567, 2.08567, 7.457),
    LolaJoint("RElbowRoll", 0.0349066, 1.54462, 6.469),
    LolaJoint("RWristYaw", -1.82387, 1.82387, 17.381),
    LolaJoint("LHand", 0.0, 1.0, inf),
    LolaJoint("RHand", 0.0, 1.0, inf),
)
JOINT_COUNT = len(LOLA_JOINTS)
LEGS = slice(7, 18)  # joints that bear the robot, in this order
NAMES = tuple(joint.name for joint in LOLA_JOINTS)
LOW = np.array([joint.low for joint in LOLA_JOINTS])
HIGH = np.array([joint.high for joint in LOLA_JOINTS])
SPEED = np.array([joint.speed for joint in LOLA_JOINTS])


class JointMap:
    """Between the joints of a description and those of LoLA.

    Axes and signs are the same: both follow the vendor's. Only the order
    differs, and that a description has no hands.
    """

    def __init__(self, names: Sequence[str]) -> None:
        """Find each joint among LoLA's.

        Args:
            names: Actuated joints, in the order of the joint targets.

        Raises:
            ModelError: If LoLA has no motor of that name, or one is named
                twice.
        """
        for name in names:
            if name not in NAMES:
                raise ModelError(
                    f"joint {name!r} has no motor in LoLA; there are "
                    f"{', '.join(NAMES)}"
                )
        if len(set(names)) != len(names):
            raise ModelError(f"joints must differ, got {', '.join(names)}")
        self._at = np.array([NAMES.index(name) for name in names])

    def from_lola(self, values: Array) -> Array:
        """Pick a description's joints from LoLA's. (25,) to (joints,)."""
        picked: Array = values[self._at]
        return picked

    def to_lola(self, values: Array, others: Array) -> Array:
        """Spread a description's joints over LoLA's.

        Args:
            values: One for each joint of the description. Shape (joints,).
            others: What joints get that the description lacks. Shape (25,).

        Returns:
            One for each motor of LoLA. Shape (25,).
        """
        spread = np.array(others, dtype=np.float64)
        spread[self._at] = values
        return spread
