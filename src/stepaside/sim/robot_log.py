"""Samples of a simulated robot: raw rows, converted when they are read."""

from collections.abc import Callable, Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from ..core.row_table import RowTable
from .ground_truth import TrueRobotState
from .world import World

Columns = dict[str, Array]


class RobotLog:
    """Samples of arrays of the simulation."""

    def __init__(
        self,
        sources: Mapping[str, Array],
        prepare: Callable[[], None],
        convert: Callable[[Columns], Columns],
    ) -> None:
        """Begin without samples of some arrays, views of shape (n,).

        ``prepare`` computes them for a sample; ``convert`` makes what the log
        gives of all samples, shapes (samples, n).
        """
        self._names, self._sources = tuple(sources), tuple(sources.values())
        self._prepare, self._convert = prepare, convert
        widths = [source.size for source in self._sources]
        self._ends = np.cumsum(widths)[:-1]
        self._table = RowTable(sum(widths))

    def add(self) -> None:
        """Sample the present state."""
        self._prepare()
        np.concatenate(self._sources, out=self._table.append())

    def truncate(self, count: int) -> None:
        """Keep only the first samples."""
        self._table.truncate(count)

    def arrays(self) -> Columns:
        """Return the samples by name."""
        parts = np.split(self._table.rows, self._ends, axis=1)
        return self._convert(dict(zip(self._names, parts, strict=True)))


def state_log(
    world: World,
    truth: TrueRobotState,
    qpos: slice,
    forces: NDArray[np.int_],
    corners: NDArray[np.int_],
) -> RobotLog:
    """Return a log of CoM, poses, ZMP and posture; see ``Trajectory``."""
    data = world.data
    # One contiguous range that contains all is copied faster.
    sensors = slice(int(forces.min()), int(forces.max()) + 1)
    sites = slice(int(corners.min()), int(corners.max()) + 1)

    def convert(found: Columns) -> Columns:
        place, torso = truth.poses_at(
            found["com"], found["origin"], found["axes"]
        )
        points = found["sites"].reshape(-1, sites.stop - sites.start, 3)
        zmp = centers_of_pressure(
            found["sensors"].take(forces - sensors.start, axis=1),
            points.take(corners - sites.start, axis=1),
        )
        return {
            "com": found["com"].copy(),
            "place": place,
            "torso": torso,
            "zmp": zmp,
            "qpos": found["qpos"].astype(np.float32),
        }

    sources: Columns = {
        "com": truth.position_com_in_world,
        "origin": truth.origin_torso_in_world,
        "axes": truth.axes_torso_in_world,
        "sensors": data.sensordata[sensors],
        "sites": data.site_xpos[sites].reshape(-1),
        "qpos": data.qpos[qpos],
    }
    return RobotLog(sources, world.update_sensors, convert)


def sensor_log(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    torso: int,
    dofs: slice,
    gyro: slice,
    accelerometer: slice,
    forces: NDArray[np.int_],
) -> RobotLog:
    """Return a log of exact sensors and efforts; see ``RobotSignals``.

    ``dofs`` are free joint, then hinges in the order of qpos.
    """
    sensors = slice(int(forces.min()), int(forces.max()) + 1)

    def convert(found: Columns) -> Columns:
        velocity, effort = found.pop("velocity"), found.pop("effort")
        found["foot_forces"] = found["foot_forces"].take(
            forces - sensors.start, axis=1
        )
        return {
            "torso_velocity": velocity[:, :6].copy(),
            "joint_velocity": velocity[:, 6:].copy(),
            "joint_effort": effort[:, 6:].copy(),
            **{name: values.copy() for name, values in found.items()},
        }

    sources: Columns = {
        "velocity": data.qvel[dofs],
        "effort": data.qfrc_actuator[dofs],
        "gyro": data.sensordata[gyro],
        "accelerometer": data.sensordata[accelerometer],
        "foot_forces": data.sensordata[sensors],
        "com_velocity": data.subtree_linvel[torso, :2],
    }
    return RobotLog(
        sources, lambda: mujoco.mj_subtreeVel(model, data), convert
    )


def centers_of_pressure(forces: Array, corners: Array) -> Array:
    """Return centres (n, 2) [m] of forces (n, corners) in the world."""
    totals = forces.sum(axis=1)
    moments = (forces[:, None, :] @ corners)[:, 0, :2]
    centers = np.full((len(forces), 2), np.nan)
    pressed = totals > 0.0
    centers[pressed] = moments[pressed] / totals[pressed, None]
    return centers
