"""NAOqi services of a simulated robot that is driven by its joints.

The methods have the names and arguments of NAOqi's own services, and are
called from threads of the ``qi`` library.
"""

from threading import Lock
from typing import Any

import numpy as np

from ...core.poses import Array
from ..lola.lola_frames import ActuatorFrame
from ..lola.nao_joints import JOINT_COUNT, NAMES
from .joint_chains import joints_of, shares_of, values_of

SHARED = "RHipYawPitch"  # driven by the motor of LHipYawPitch
KNOWN = (*NAMES, SHARED)


class JointServiceState:
    """State that the services share, guarded by a lock.

    Attributes:
        lock: Must be held to read or write the other attributes.
        values: Values of ALMemory, by key.
        angles: Measured joint angles, in [rad]. Shape (25,).
        targets: Newest joint targets, in [rad]. Shape (25,).
        stiffness: Newest commanded stiffness, from 0 to 1. Shape (25,).
        answered: Whether a client has set or released the joints since the
            last frame.
        commanded: Whether there is a command that has not been taken.
    """

    def __init__(self) -> None:
        """Start with limp joints and no values."""
        self.lock = Lock()
        self.values: dict[str, Any] = {}
        self.angles: Array = np.zeros(JOINT_COUNT)
        self.targets: Array = np.zeros(JOINT_COUNT)
        self.stiffness: Array = np.zeros(JOINT_COUNT)
        self.answered = self.commanded = False

    def command(self, *, answers: bool) -> None:
        """Note a command; the caller holds the lock."""
        self.commanded = True
        self.answered = self.answered or answers

    def taken(self) -> ActuatorFrame | None:
        """Take the command since the last call; None without one."""
        with self.lock:
            if not self.commanded:
                return None
            self.commanded = False
            return ActuatorFrame(self.targets.copy(), self.stiffness.copy())


class JointMotionService:
    """ALMotion: stiffness and joint angles."""

    def __init__(self, robot: JointServiceState) -> None:
        """Create the service of a robot."""
        self._robot = robot

    def wakeUp(self) -> None:
        """Make all joints stiff at their present angles."""
        robot = self._robot
        with robot.lock:
            robot.targets = robot.angles.copy()
            robot.stiffness = np.ones(JOINT_COUNT)
            robot.command(answers=False)

    def rest(self) -> None:
        """Make all joints limp."""
        with self._robot.lock:
            self._robot.stiffness = np.zeros(JOINT_COUNT)
            self._robot.command(answers=True)

    def robotIsWakeUp(self) -> bool:
        """Return whether all joints are stiff."""
        with self._robot.lock:
            return bool(self._robot.stiffness.min() > 0.0)

    def stopMove(self) -> None:
        """Do nothing: there is no walking control."""

    def setStiffnesses(self, names: Any, stiffness: Any) -> None:
        """Set the stiffness of joints or chains, from 0 to 1."""
        joints, at = _indices(names)
        values = shares_of(joints, stiffness)
        with self._robot.lock:
            self._robot.stiffness[at] = values
            limp = bool(self._robot.stiffness.max() == 0.0)
            self._robot.command(answers=limp)

    def setAngles(self, names: Any, angles: Any, fraction: float) -> None:
        """Set joint targets, in [rad], which are applied at once."""
        joints, at = _indices(names)
        values = values_of(joints, angles, "angles")
        if not 0.0 < fraction <= 1.0:
            raise ValueError(f"fraction must lie in (0, 1], got {fraction}")
        with self._robot.lock:
            self._robot.targets[at] = values
            self._robot.command(answers=True)

    def getBodyNames(self, name: str) -> list[str]:
        """Return the names of the joints of a chain."""
        return joints_of(name, KNOWN)

    def getAngles(self, names: Any, use_sensors: bool) -> list[float]:
        """Return measured or commanded joint angles, in [rad]."""
        with self._robot.lock:
            robot = self._robot
            angles = robot.angles if use_sensors else robot.targets
            selected: list[float] = angles[_indices(names)[1]].tolist()
            return selected


class JointMemoryService:
    """ALMemory: values by key."""

    def __init__(self, robot: JointServiceState) -> None:
        """Create the service of a robot."""
        self._robot = robot

    def getData(self, key: str) -> Any:
        """Return the value of a key."""
        with self._robot.lock:
            return self._robot.values[key]

    def getListData(self, keys: Any) -> list[Any]:
        """Return the values of keys; None for unknown keys."""
        with self._robot.lock:
            return [self._robot.values.get(key) for key in keys]


def _indices(names: Any) -> tuple[list[str], list[int]]:
    """Return the joints that names stand for, and their indices."""
    joints = joints_of(names, KNOWN)
    return joints, [
        NAMES.index("LHipYawPitch" if name == SHARED else name)
        for name in joints
    ]
