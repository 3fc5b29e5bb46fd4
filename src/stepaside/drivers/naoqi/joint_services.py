"""NAOqi's services for a simulated robot whose joints a client moves.

Methods are called from threads of the messaging, by the names and with the
arguments that NAOqi's own services have.
"""

from threading import Lock
from typing import Any

import numpy as np

from ...core.poses import Array
from ..joint.frames import ActuatorFrame
from ..joint.joint_map import JOINT_COUNT, NAMES
from .joint_chains import joints_of, shares_of, values_of

SHARED = "RHipYawPitch"  # the motor of LHipYawPitch turns both
KNOWN = (*NAMES, SHARED)


class JointServiceState:
    """What the services share, guarded by one lock.

    Attributes:
        lock: Held by whoever reads or writes.
        values: What ALMemory tells, by key.
        angles: Of the joints, in [rad]. Shape (25,).
        targets: Commanded last, in [rad]. Shape (25,).
        stiffness: Commanded last, shares of the torque. Shape (25,).
        answered: Whether the last frame was: joints were set, or let go.
        commanded: Whether anything was, that has not been taken.
    """

    def __init__(self) -> None:
        """Begin limp, with nothing told."""
        self.lock = Lock()
        self.values: dict[str, Any] = {}
        self.angles: Array = np.zeros(JOINT_COUNT)
        self.targets: Array = np.zeros(JOINT_COUNT)
        self.stiffness: Array = np.zeros(JOINT_COUNT)
        self.answered = self.commanded = False

    def command(self, *, answers: bool) -> None:
        """Note a command; the lock is held."""
        self.commanded = True
        self.answered = self.answered or answers

    def taken(self) -> ActuatorFrame | None:
        """What was commanded since the last time; None if nothing was."""
        with self.lock:
            if not self.commanded:
                return None
            self.commanded = False
            return ActuatorFrame(self.targets.copy(), self.stiffness.copy())


class JointMotionService:
    """ALMotion: stiffness and joint angles."""

    def __init__(self, robot: JointServiceState) -> None:
        """Move a robot."""
        self._robot = robot

    def wakeUp(self) -> None:
        """Make the motors stiff where they are."""
        robot = self._robot
        with robot.lock:
            robot.targets = robot.angles.copy()
            robot.stiffness = np.ones(JOINT_COUNT)
            robot.command(answers=False)

    def rest(self) -> None:
        """Let the motors go."""
        with self._robot.lock:
            self._robot.stiffness = np.zeros(JOINT_COUNT)
            self._robot.command(answers=True)

    def robotIsWakeUp(self) -> bool:
        """Whether the motors are stiff."""
        with self._robot.lock:
            return bool(self._robot.stiffness.min() > 0.0)

    def stopMove(self) -> None:
        """Nothing: it does not walk by itself."""

    def setStiffnesses(self, names: Any, stiffness: Any) -> None:
        """Set shares of the torque, from 0 to 1."""
        joints, at = _places(names)
        values = shares_of(joints, stiffness)
        with self._robot.lock:
            self._robot.stiffness[at] = values
            limp = bool(self._robot.stiffness.max() == 0.0)
            self._robot.command(answers=limp)

    def setAngles(self, names: Any, angles: Any, fraction: float) -> None:
        """Set joint targets, in [rad], that are taken at once."""
        joints, at = _places(names)
        values = values_of(joints, angles, "angles")
        if not 0.0 < fraction <= 1.0:
            raise ValueError(f"fraction must lie in (0, 1]: {fraction}")
        with self._robot.lock:
            self._robot.targets[at] = values
            self._robot.command(answers=True)

    def getBodyNames(self, name: str) -> list[str]:
        """Names of the joints of a chain."""
        return joints_of(name, KNOWN)

    def getAngles(self, names: Any, use_sensors: bool) -> list[float]:
        """Angles of joints, in [rad]."""
        with self._robot.lock:
            robot = self._robot
            angles = robot.angles if use_sensors else robot.targets
            told: list[float] = angles[_places(names)[1]].tolist()
            return told


class JointMemoryService:
    """ALMemory: values by key."""

    def __init__(self, robot: JointServiceState) -> None:
        """Know the robot."""
        self._robot = robot

    def getData(self, key: str) -> Any:
        """One value."""
        with self._robot.lock:
            return self._robot.values[key]

    def getListData(self, keys: Any) -> list[Any]:
        """Values; None for what there is not."""
        with self._robot.lock:
            return [self._robot.values.get(key) for key in keys]


def _places(names: Any) -> tuple[list[str], list[int]]:
    """Return joints by the names of joints or chains, and their places."""
    joints = joints_of(names, KNOWN)
    return joints, [
        NAMES.index("LHipYawPitch" if name == SHARED else name)
        for name in joints
    ]
