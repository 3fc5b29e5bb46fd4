"""The record of a run: arrays by name, one row per sample."""

from collections.abc import Sequence

import numpy as np

from ..control import ControlScheme
from ..planning import Foot
from ..poses import Array, Pose
from ..world.robot import SimulatedRobot

PERIOD = 0.02  # between samples, in [s]


class Recorder:
    """Samples a run into lists, and hands them out as arrays.

    Every name but ``times_s`` begins with the robot's: ``com`` (n, 3),
    ``torso`` (n, 3: x, y, heading), ``com_reference`` (n, 2),
    ``zmp_reference`` (n, 2), ``zmp`` (n, 2, from the foot forces),
    ``qpos`` (n, joints and free joint), ``landings`` (m, 5: time, side,
    x, y, heading). Positions are in the world, in [m], angles in [rad].
    """

    def __init__(
        self,
        robots: Sequence[SimulatedRobot],
        schemes: Sequence[ControlScheme],
        frames: Sequence[Pose],
    ) -> None:
        """Record robots driven by schemes, placed at frames."""
        self._robots, self._schemes = robots, schemes
        self.frames = frames
        world = robots[0].world
        self._qpos = world.data.qpos
        self._world = world
        self.every = max(1, round(PERIOD / world.physics.tick))
        self._times: list[float] = []
        self._rows: list[list[tuple[float, ...]]] = [[] for _ in robots]
        self._postures: list[Array] = []

    def sample(self) -> None:
        """Take one sample of every robot."""
        self._times.append(self._world.time)
        self._postures.append(self._qpos.astype(np.float32))
        for rows, robot, scheme in zip(
            self._rows, self._robots, self._schemes, strict=True
        ):
            truth = robot.truth
            rows.append(
                (
                    *truth.com.tolist(),
                    *truth.position,
                    truth.heading,
                    *scheme.reference.com[:2],
                    *scheme.zmp_reference,
                    *robot.measured_zmp(),
                )
            )

    def arrays(self) -> dict[str, Array]:
        """Everything recorded so far."""
        out: dict[str, Array] = {"times_s": np.array(self._times)}
        postures = np.array(self._postures)
        for rows, robot, scheme, frame in zip(
            self._rows,
            self._robots,
            self._schemes,
            self.frames,
            strict=True,
        ):
            table = np.array(rows, dtype=np.float64).reshape(-1, 12)
            name = robot.name
            out[f"{name}_com"] = table[:, 0:3]
            out[f"{name}_torso"] = np.column_stack(
                [table[:, 3:5], np.unwrap(table[:, 5])]
            )
            for key, column in (("com_reference", 6), ("zmp_reference", 8)):
                out[f"{name}_{key}"] = frame.transform_points(
                    table[:, column : column + 2]
                )
            out[f"{name}_zmp"] = table[:, 10:12]
            out[f"{name}_qpos"] = postures[:, robot.qpos_slice]
            out[f"{name}_landings"] = _landings(scheme, frame)
        return out


def _landings(scheme: ControlScheme, frame: Pose) -> Array:
    rows = [
        (time, 1.0 if foot is Foot.LEFT else -1.0, *frame.compose(pose))
        for time, foot, pose in scheme.landings
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 5)
