"""Trajectory of a robot by its own odometry, from recorded joint angles."""

from math import cos, sin

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from ..core.rotations import quaternion_of, rotation
from ..perception.attitude import AttitudeFilter
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import (
    ForwardKinematics,
    MeasuredPosture,
    SpatialTorsoPose,
    torso_pose_on_foot,
)
from .play_rows import PlayedRows
from .trajectory import Trajectory

ACCELEROMETER_GAIN = 0.5  # of the attitude filter, in [1/s]
MIN_FOOT_FORCE = 1.0  # below which the ZMP is unknown, in [N]


class OdometryPath:
    """Reconstruction of a robot's motion from its recorded rows.

    In each row the robot stands on the support foot of its controller, with
    the tilt of its IMU and the measured joint angles; on learned legs its CoM
    is at the place of their odometry, and its lowest sole on the floor. Each
    controller that was started has its own odometry, whose origin is midway
    between the last feet positions in the odometry of the controller before
    it.
    """

    def __init__(
        self, rows: PlayedRows, description: RobotDescription, tilts: Array
    ) -> None:
        """Take the rows of a robot.

        Args:
            rows: Rows of a player that commanded joints.
            description: Description of the robot.
            tilts: Roll and pitch of the torso in each row, in [rad]. Shape
                (rows, 2).

        Raises:
            ConfigurationError: If the number of joints differs.
        """
        self._rows, self._columns = rows, rows.columns
        self._forward = ForwardKinematics(description)
        tree = self._forward.tree
        self._tree, self._standing = tree, description.standing
        joints = rows.columns["joint_positions"].shape[1]
        if joints != len(tree.motors):
            raise ConfigurationError(
                f"a player of {description.name} must measure "
                f"{len(tree.motors)} joints, got {joints}"
            )
        self._sensors = self._forward.force_sensors()
        self._tilts = tilts

    def track(self, gait: GaitSettings, sight: Array) -> Trajectory:
        """Return the trajectory at the samples of the run.

        Returns:
            Trajectory in the odometry of the first controller.
        """
        columns = self._columns
        sampled = self._rows.sampled
        frames = self._frames()
        controllers = columns["mind"]
        rows: dict[str, list[Array]] = {}
        for row in sampled.tolist():
            frame = frames[float(controllers[row])]
            posture, body = self._stand(row, frame)
            com = (
                body.position_in_odometry
                + body.axes_in_odometry @ posture.position_com_in_torso
            )
            c, s = cos(body.heading_in_odometry), sin(body.heading_in_odometry)
            zmp_offset = gait.zmp_forward * np.array([c, s])
            for name, value in (
                ("com", com),
                (
                    "torso",
                    [*body.position_in_odometry[:2], body.heading_in_odometry],
                ),
                ("place", [*(com[:2] - zmp_offset), body.heading_in_odometry]),
                ("qpos", self._qpos(row, body)),
                ("zmp", self._zmp(row, posture, body)),
                (
                    "com_reference",
                    frame.transform_points(columns["com_reference"][row]),
                ),
                (
                    "zmp_reference",
                    frame.transform_points(columns["zmp_reference"][row]),
                ),
            ):
                rows.setdefault(name, []).append(np.asarray(value))
        arrays = {name: np.array(values) for name, values in rows.items()}
        for name in ("com_reference", "zmp_reference"):
            if np.isnan(arrays[name]).all():  # learned legs have none
                del arrays[name]
        for name in ("place", "torso"):
            arrays[name][:, 2] = np.unwrap(arrays[name][:, 2])
        arrays["qpos"] = arrays["qpos"].astype(np.float32)
        return Trajectory(
            **arrays, landings=self._landings(frames), sight=sight
        )

    def _frames(self) -> dict[float, Pose]:
        """Return the odometry of each controller in that of the first."""
        controllers = self._columns["mind"]
        changes = np.flatnonzero(np.diff(controllers))
        last_rows = np.append(changes, len(controllers) - 1)
        frames, frame = {}, Pose(0.0, 0.0, 0.0)
        for row in last_rows.tolist():
            frames[float(controllers[row])] = frame
            posture, body = self._stand(row, frame)
            x, y, _ = (
                body.position_in_odometry
                + body.axes_in_odometry
                @ posture.positions_feet_in_torso.mean(axis=0)
            ).tolist()
            frame = Pose(x, y, body.heading_in_odometry)
        return frames

    def _stand(
        self, row: int, frame: Pose
    ) -> tuple[MeasuredPosture, SpatialTorsoPose]:
        x, y, heading, side = self._columns["support"][row].tolist()
        measured = self._columns["joint_positions"][row].copy()
        posture = self._forward.posture(measured)
        support = frame.compose(Pose(x, y, heading))
        roll, pitch = self._tilts[row].tolist()
        if np.isnan(side):
            return posture, self._stand_under_com(
                posture, support, (roll, pitch)
            )
        foot = 0 if side > 0.0 else 1
        return posture, torso_pose_on_foot(
            posture, foot, support, (roll, pitch)
        )

    def _stand_under_com(
        self,
        posture: MeasuredPosture,
        support: Pose,
        tilt: tuple[float, float],
    ) -> SpatialTorsoPose:
        """Return the torso of a robot whose lowest sole touches the floor.

        Args:
            posture: Measured posture.
            support: Place of the CoM, and heading of the torso.
            tilt: Roll and pitch of the torso, in [rad].
        """
        axes = rotation(*tilt, support.theta)
        corners = self._corners(posture)
        com = axes @ posture.position_com_in_torso
        lowest = float((corners @ axes.T)[:, 2].min())
        place = np.array([support.x - com[0], support.y - com[1], -lowest])
        return SpatialTorsoPose(place, axes, support.theta)

    def _qpos(self, row: int, body: SpatialTorsoPose) -> Array:
        """Return position and quaternion of the torso, then all joints."""
        measured = self._columns["joint_positions"][row].tolist()
        known = dict(self._standing)
        known |= dict(zip(self._tree.motors, measured, strict=True))
        for follower, leader in self._tree.followers.items():
            known[follower] = known.get(leader, 0.0)
        joints = [known.get(name, 0.0) for name in self._tree.joints]
        roll, pitch = self._tilts[row].tolist()
        quaternion = quaternion_of(roll, pitch, body.heading_in_odometry)
        return np.array([*body.position_in_odometry, *quaternion, *joints])

    def _zmp(
        self, row: int, posture: MeasuredPosture, body: SpatialTorsoPose
    ) -> Array:
        """Return the center of the foot forces; NaN without any force."""
        forces = self._columns["foot_forces"][row]
        total = float(forces.sum())
        if not total > MIN_FOOT_FORCE:
            return np.full(2, np.nan)
        center_in_torso = forces @ self._corners(posture) / total
        center: Array = (
            body.position_in_odometry + body.axes_in_odometry @ center_in_torso
        )[:2]
        return center

    def _corners(self, posture: MeasuredPosture) -> Array:
        """Return the force sensors in the torso frame, in [m]. (8, 3)."""
        flat = np.column_stack([self._sensors, np.zeros(len(self._sensors))])
        return np.concatenate(
            [
                posture.positions_feet_in_torso[i]
                + flat[4 * i : 4 * i + 4] @ posture.axes_feet_in_torso[i].T
                for i in range(2)
            ]
        )

    def _landings(self, frames: dict[float, Pose]) -> Array:
        begun, controllers = self._columns["begun"], self._columns["mind"]
        landings = []
        for row in np.flatnonzero(~np.isnan(begun[:, 0])).tolist():
            time, side, x, y, heading, _ = begun[row].tolist()
            frame = frames[float(controllers[row])]
            landing = frame.compose(Pose(x, y, heading))
            time += float(self._rows.offset[row])
            landings.append([time, side, *landing])
        return np.array(landings, dtype=np.float64).reshape(-1, 5)


def estimate_tilts(rows: PlayedRows) -> Array:
    """Estimate roll and pitch of the torso from the recorded IMU.

    Returns:
        Roll and pitch in each row, in [rad]. Shape (rows, 2).
    """
    attitude = AttitudeFilter(ACCELEROMETER_GAIN, 0.0, calibration=0.0)
    gyro, force = rows.columns["gyro"], rows.columns["accelerometer"]
    passed = np.diff(rows.times, prepend=0.0).tolist()
    tilts = np.zeros((len(gyro), 2))
    for row, duration in enumerate(passed):
        attitude.update(gyro[row], force[row], (0.0, 0.0), duration)
        tilts[row] = attitude.roll, attitude.pitch
    return tilts
