"""Joints of a simulated robot that a client commands."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from ...core.poses import Array
from ...perception.attitude import AttitudeFilter
from ...perception.measurement import Measurement
from ..joint.joint_map import JointMap
from .conventions import sensor_frame_of
from .lola_frames import ActuatorFrame, SensorFrame
from .nao_joints import JOINT_COUNT, LEGS, NAO_MOTORS, TICK

SILENT = 8  # ticks without a command before stiffness decays: 0.1 s
ATTITUDE_GAIN = 0.5  # of the accelerometer in the attitude, in [1/s]
FADING = 0.5  # from full stiffness to none, in [s]
SETTLED = 40  # ticks after which constant stiffness counts as final


class ServedJointRobot(Protocol):
    """Simulated robot that can be driven by its joints."""

    def sensors(self) -> Measurement:
        """Return the measurement of this tick."""

    def command(self, targets: Array, stiffness: Array) -> None:
        """Set joint targets, in [rad], and stiffness, from 0 to 1."""


class ServedJoints:
    """Joints of a simulated robot under a client's commands.

    A tick is :meth:`sense`, then :meth:`take` for each command, then
    :meth:`act`. Stiffness decays if it is not commanded repeatedly.

    Attributes:
        measurement: Newest measurement.
        share: Fraction of the commanded stiffness that is applied.
        stiffness: Stiffness of the motors now. Shape (25,).
    """

    def __init__(
        self, robot: ServedJointRobot, joint_names: Sequence[str]
    ) -> None:
        """Start limp.

        Args:
            robot: The simulated robot.
            joint_names: Its joints, in the order of its measurements.

        Raises:
            ModelError: If LoLA has no motor for one of the joints.
        """
        self._robot, self._joints = robot, JointMap(joint_names, NAO_MOTORS)
        self._attitude = AttitudeFilter(ATTITUDE_GAIN, 0.0, calibration=0.0)
        self._silent = 0
        self._unchanged = 0
        self.share = 0.0
        self._commanded: Array = np.zeros(JOINT_COUNT)
        self.stiffness: Array = np.zeros(JOINT_COUNT)
        self.targets: Array = np.zeros(JOINT_COUNT)
        self._has_targets = False

    @property
    def stiff(self) -> bool:
        """Whether the legs have the stiffness that the client wants."""
        least = float(self.stiffness[LEGS].min())
        return least > 0.99 or (least > 0.0 and self._unchanged >= SETTLED)

    def sense(self) -> Measurement:
        """Read the sensors."""
        self.measurement = self._robot.sensors()
        own, seen = self._attitude, self.measurement
        own.update(seen.gyro, seen.accelerometer, (0.0, 0.0), TICK)
        if not self._has_targets:
            self.targets = self._joints.to_motors(
                seen.joint_positions, np.zeros(JOINT_COUNT)
            )
        return seen

    def frame(
        self, count: int, *, chest_pressed: bool, lock_step: bool
    ) -> SensorFrame:
        """Return the sensor frame of the newest measurement.

        Args:
            count: Number of the frame.
            chest_pressed: Whether the chest button is pressed.
            lock_step: Whether the simulation waits for answers.
        """
        own = self._attitude
        return sensor_frame_of(
            self.measurement,
            self._joints,
            angles=(own.roll, own.pitch),
            stiffness=self.stiffness,
            count=count,
            chest_pressed=chest_pressed,
            lock_step=lock_step,
        )

    def take(self, frame: ActuatorFrame) -> None:
        """Take a client's command."""
        if frame.position is not None:
            self.targets, self._has_targets = frame.position, True
        if frame.stiffness is not None:
            self._commanded = frame.stiffness
            self._silent, self.share = 0, 1.0

    def act(self) -> None:
        """Command the robot for one tick."""
        if self._silent >= SILENT:
            self.share = max(0.0, self.share - TICK / FADING)
        self._silent += 1
        stiffness = self.share * self._commanded
        stays = np.array_equal(stiffness, self.stiffness)
        self._unchanged = self._unchanged + 1 if stays else 0
        self.stiffness = stiffness
        pick = self._joints.from_motors
        self._robot.command(pick(self.targets), pick(self.stiffness))
