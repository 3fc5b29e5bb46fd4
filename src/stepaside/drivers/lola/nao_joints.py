"""Motors of NAO: order, ranges, speeds and currents, and its crouch."""

from math import inf
from typing import NamedTuple

import numpy as np

from ..joint.joint_map import MotorTable

TICK = 0.012  # from one frame to the next, in [s]


class LolaJoint(NamedTuple):
    """One of the 25 motors.

    Attributes:
        name: Its name. LHipYawPitch turns both hips: its motor is shared.
        low: Minimum angle, in [rad]; closed, for a hand, in [1].
        high: Maximum angle, in [rad]; open, for a hand, in [1].
        speed: No-load speed through the gear, in [rad/s].
        torque: Stall torque through an ideal gear, in [N m].
    """

    name: str
    low: float
    high: float
    speed: float
    torque: float


# Facts that vendor and teams published; docs/nao.md names the sources.
LOLA_JOINTS = (
    LolaJoint("HeadYaw", -2.08567, 2.08567, 7.457, 2.149),
    LolaJoint("HeadPitch", -0.671952, 0.514872, 6.469, 2.477),
    LolaJoint("LShoulderPitch", -2.08567, 2.08567, 7.944, 3.366),
    LolaJoint("LShoulderRoll", -0.314159, 1.32645, 6.469, 2.477),
    LolaJoint("LElbowYaw", -2.08567, 2.08567, 7.457, 2.149),
    LolaJoint("LElbowRoll", -1.54462, -0.0349066, 6.469, 2.477),
    LolaJoint("LWristYaw", -1.82387, 1.82387, 17.381, 0.476),
    LolaJoint("LHipYawPitch", -1.14529, 0.740718, 4.526, 13.085),
    LolaJoint("LHipRoll", -0.379435, 0.79046, 4.526, 13.085),
    LolaJoint("LHipPitch", -1.53589, 0.48398, 6.963, 8.505),
    LolaJoint("LKneePitch", -0.0923279, 2.11255, 6.963, 8.505),
    LolaJoint("LAnklePitch", -1.18944, 0.922581, 6.963, 8.505),
    LolaJoint("LAnkleRoll", -0.397761, 0.768992, 4.526, 13.085),
    LolaJoint("RHipRoll", -0.79046, 0.379435, 4.526, 13.085),
    LolaJoint("RHipPitch", -1.53589, 0.48398, 6.963, 8.505),
    LolaJoint("RKneePitch", -0.0923279, 2.11255, 6.963, 8.505),
    LolaJoint("RAnklePitch", -1.1863, 0.932006, 6.963, 8.505),
    LolaJoint("RAnkleRoll", -0.768992, 0.397761, 4.526, 13.085),
    LolaJoint("RShoulderPitch", -2.08567, 2.08567, 7.944, 3.366),
    LolaJoint("RShoulderRoll", -1.32645, 0.314159, 6.469, 2.477),
    LolaJoint("RElbowYaw", -2.08567, 2.08567, 7.457, 2.149),
    LolaJoint("RElbowRoll", 0.0349066, 1.54462, 6.469, 2.477),
    LolaJoint("RWristYaw", -1.82387, 1.82387, 17.381, 0.476),
    LolaJoint("LHand", 0.0, 1.0, inf, inf),
    LolaJoint("RHand", 0.0, 1.0, inf, inf),
)
JOINT_COUNT = len(LOLA_JOINTS)
LEGS = slice(7, 18)  # joints that bear the robot, in this order
NAMES = tuple(joint.name for joint in LOLA_JOINTS)
LOW = np.array([joint.low for joint in LOLA_JOINTS])
HIGH = np.array([joint.high for joint in LOLA_JOINTS])
SPEED = np.array([joint.speed for joint in LOLA_JOINTS])
# The battery has six cells of 3.6 V, 4.2 V when they are full. A direct
# current motor that turns at its no-load speed by that voltage stalls at
# torque times speed over voltage: 3.2 A in the legs. That the data sheet's
# speeds are those at 21.6 V is an assumption.
NOMINAL_VOLTAGE, HIGHEST_VOLTAGE = 21.6, 25.2  # in [V]
STALL_CURRENT = (
    np.array([joint.torque * joint.speed for joint in LOLA_JOINTS])
    * HIGHEST_VOLTAGE
    / NOMINAL_VOLTAGE**2
)  # in [A]
# Legs folded over the feet: the robot does not fall when it goes limp.
CROUCH = {
    "HipYawPitch": 0.0,
    "HipRoll": 0.0,
    "HipPitch": -0.92,
    "KneePitch": 2.1,
    "AnklePitch": -1.18,
    "AnkleRoll": 0.0,
}
NAO_MOTORS = MotorTable(
    NAMES,
    LOW,
    HIGH,
    SPEED,
    STALL_CURRENT,
    legs=np.arange(JOINT_COUNT)[LEGS],
    crouch={name: CROUCH[name[1:]] for name in NAMES if name[1:] in CROUCH},
    tick=TICK,
)
