"""Log of a simulated robot and of the references of its controller."""

import numpy as np

from ..core.poses import Array, Pose
from ..core.row_table import RowTable
from ..locomotion.maneuver_walk import ManeuverWalk
from ..planning import Foot
from ..sim.simulated_robot import SimulatedRobot

NO_ESTIMATE = (np.nan,) * 8
CLOSE_COLUMNS = {
    "velocity": 2,
    "tilt": 2,
    "sole": 3,
    "support": 5,
    "heading_reference": 1,
    "estimate": 8,
}


class WalkerLog:
    """Samples of a simulated robot, with its plan and estimates.

    Samples are raw rows; planned and estimated quantities are in odometry
    until the log is read.
    """

    def __init__(
        self,
        robot: SimulatedRobot,
        locomotion: ManeuverWalk,
        frame: Pose,
        *,
        closely: bool,
    ) -> None:
        """Begin without samples.

        Args:
            robot: The robot.
            locomotion: Its locomotion.
            frame: Pose of its odometry in the world.
            closely: Whether to record foot states and estimates.
        """
        self._robot, self._locomotion, self._frame = robot, locomotion, frame
        self._states = robot.state_log()
        self._references = RowTable(4)
        self._close = (
            RowTable(sum(CLOSE_COLUMNS.values())) if closely else None
        )

    def add(self) -> None:
        """Sample the present state."""
        self._states.add()
        self._references.append()[:] = self._locomotion.planned_centers
        if self._close is not None:
            self._close.append()[:] = self._close_row()

    def truncate(self, count: int) -> None:
        """Keep only the first samples."""
        self._states.truncate(count)
        self._references.truncate(count)
        if self._close is not None:
            self._close.truncate(count)

    def arrays(self) -> dict[str, Array]:
        """Return true, planned and estimated arrays, in the world."""
        frame, planned = self._frame, self._references.rows
        arrays = self._states.arrays()
        arrays["com_reference"] = frame.transform_points(planned[:, :2])
        arrays["zmp_reference"] = frame.transform_points(planned[:, 2:])
        if self._close is not None:
            arrays |= _close_arrays(self._close.rows, frame)
        return arrays

    def _close_row(self) -> tuple[float, ...]:
        """Return foot states and estimates, in the order of their columns."""
        walk, stance = self._locomotion, self._robot.stance
        step = walk.step(self._robot.world.time)
        foot = step.swing.other
        single = float(step.walking and step.remaining > 0.0)
        sole = stance.left_sole if foot is Foot.LEFT else stance.right_sole
        state = walk.balance.state
        return (
            *stance.velocity,
            *stance.tilt,
            *sole,
            foot.value,
            single,
            *step.support,
            walk.balance.planned_heading,
            *(
                NO_ESTIMATE
                if state is None
                else (*state.com, *state.velocity, *state.zmp, *state.tilt)
            ),
        )


def _close_arrays(rows: Array, frame: Pose) -> dict[str, Array]:
    """Return foot states and estimates in the world, by name.

    Args:
        rows: Rows of :data:`CLOSE_COLUMNS`.
        frame: Pose of the odometry in the world; an estimate that is NaN
            throughout is left out.
    """
    ends = np.cumsum(list(CLOSE_COLUMNS.values()))[:-1]
    parts = np.split(rows.copy(), ends, axis=1)
    arrays = dict(zip(CLOSE_COLUMNS, parts, strict=True))
    support, rotation = arrays["support"], Pose(0.0, 0.0, frame.theta)
    support[:, 2:4] = frame.transform_points(support[:, 2:4])
    support[:, 4] += frame.theta
    arrays["heading_reference"] += frame.theta
    estimate = arrays["estimate"]
    if np.isnan(estimate).all():
        del arrays["estimate"]
        return arrays
    estimate[:, 0:2] = frame.transform_points(estimate[:, 0:2])
    estimate[:, 2:4] = rotation.transform_points(estimate[:, 2:4])
    estimate[:, 4:6] = frame.transform_points(estimate[:, 4:6])
    return arrays
