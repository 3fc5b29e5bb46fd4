"""Exact sensor values, joint velocities and efforts of a robot, as rows."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from ..core.row_table import RowTable
from .true_stance import StanceWatch


class SensorAddresses(NamedTuple):
    """Places of a robot's values in the arrays of MuJoCo.

    Attributes:
        dofs: Part of ``qvel``: free joint, then hinges in the order of qpos.
        gyro: Part of ``sensordata``.
        accelerometer: Part of ``sensordata``.
        forces: Indices of the foot forces in ``sensordata``. Shape (8,).
    """

    dofs: slice
    gyro: slice
    accelerometer: slice
    forces: NDArray[np.int_]


class RobotSensorLog:
    """Samples of what sensors without errors of one robot would measure.

    Sensor values and efforts are those of the last step of the physics.
    """

    def __init__(
        self,
        data: mujoco.MjData,
        stance: StanceWatch,
        addresses: SensorAddresses,
    ) -> None:
        """Begin without samples.

        Args:
            data: State of the world.
            stance: Reader of the velocity of the robot's CoM.
            addresses: Places of the robot's values.
        """
        self._stance = stance
        self._sources: tuple[Array, ...] = (
            data.qvel[addresses.dofs],
            data.qfrc_actuator[addresses.dofs],
            data.sensordata[addresses.gyro],
            data.sensordata[addresses.accelerometer],
        )
        self._sensors: Array = data.sensordata
        self._forces = addresses.forces
        widths = [*(s.size for s in self._sources), addresses.forces.size, 2]
        self._ends = np.cumsum(widths)[:-1]
        self._table = RowTable(sum(widths))

    def add(self) -> None:
        """Sample the present state."""
        np.concatenate(
            (
                *self._sources,
                self._sensors.take(self._forces),
                self._stance.read().velocity,
            ),
            out=self._table.append(),
        )

    def truncate(self, count: int) -> None:
        """Keep only the first samples."""
        self._table.truncate(count)

    def arrays(self) -> dict[str, Array]:
        """Return the samples by name; see ``RobotSignals`` of the games."""
        velocity, effort, gyro, accelerometer, forces, com = np.split(
            self._table.rows.copy(), self._ends, axis=1
        )
        return {
            "torso_velocity": velocity[:, :6],
            "joint_velocity": velocity[:, 6:],
            "joint_effort": effort[:, 6:],
            "gyro": gyro,
            "accelerometer": accelerometer,
            "foot_forces": forces,
            "com_velocity": com,
        }
