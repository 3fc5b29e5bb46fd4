"""True states of a robot, sampled as raw rows and converted at the end."""

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from ..core.row_table import RowTable
from .ground_truth import TrueRobotState
from .world import World


class RobotStateLog:
    """Samples of the true state of one robot.

    A sample copies values of the simulation; poses and ZMP are computed for
    all samples at once when the log is read.
    """

    def __init__(
        self,
        world: World,
        truth: TrueRobotState,
        qpos: slice,
        forces: NDArray[np.int_],
        corners: NDArray[np.int_],
    ) -> None:
        """Begin without samples.

        Args:
            world: World of the robot.
            truth: True state of the robot.
            qpos: Part of qpos of the robot.
            forces: Addresses of the foot force sensors in ``sensordata``.
            corners: Indices of the sites of these sensors.
        """
        self._truth = truth
        self._update_sensors, data = world.update_sensors, world.data
        # One contiguous range that contains all is copied faster.
        sensors = slice(int(forces.min()), int(forces.max()) + 1)
        sites = slice(int(corners.min()), int(corners.max()) + 1)
        self._forces = forces - sensors.start
        self._corners = corners - sites.start
        self._sources: tuple[Array, ...] = (
            truth.position_com_in_world,
            truth.origin_torso_in_world,
            truth.axes_torso_in_world,
            data.sensordata[sensors],
            data.site_xpos[sites].reshape(-1),
            data.qpos[qpos],
        )
        widths = [source.size for source in self._sources]
        self._ends = np.cumsum(widths)[:-1]
        self._table = RowTable(sum(widths))

    def add(self) -> None:
        """Sample the present state."""
        self._update_sensors()
        np.concatenate(self._sources, out=self._table.append())

    def truncate(self, count: int) -> None:
        """Keep only the first samples."""
        self._table.truncate(count)

    def arrays(self) -> dict[str, Array]:
        """Return CoM, poses, ZMP and posture by name; see ``Trajectory``."""
        parts = np.split(self._table.rows, self._ends, axis=1)
        com, origin, axes, sensors, sites, qpos = parts
        place, torso = self._truth.poses_at(com, origin, axes)
        sites = sites.reshape(-1, sites.shape[1] // 3, 3)
        return {
            "com": com.copy(),
            "place": place,
            "torso": torso,
            "zmp": centers_of_pressure(
                sensors.take(self._forces, axis=1),
                sites.take(self._corners, axis=1),
            ),
            "qpos": qpos.astype(np.float32),
        }


def centers_of_pressure(forces: Array, corners: Array) -> Array:
    """Return the centres of pressure in the world; NaN without a force.

    Args:
        forces: Normal forces, in [N]. Shape (n, corners).
        corners: Their points in the world, in [m]. Shape (n, corners, 3).

    Returns:
        Centres (x, y), in [m]. Shape (n, 2).
    """
    totals = forces.sum(axis=1)
    moments = (forces[:, None, :] @ corners)[:, 0, :2]
    centers = np.full((len(forces), 2), np.nan)
    pressed = totals > 0.0
    centers[pressed] = moments[pressed] / totals[pressed, None]
    return centers
