"""The way of a robot whose joints were moved, as it believed itself."""

from math import cos, sin

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from ..perception.attitude import AttitudeFilter
from ..planning import GaitSettings
from ..robots.body_pose import StandingBody, stand_on
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics, MeasuredPosture
from .play_rows import PlayedRows
from .trajectory import Trajectory

BELIEF = 0.5  # rate at which the accelerometer is believed, in [1/s]
PRESSED = 1.0  # force on the feet below which they say nothing, in [N]


class OdometryPath:
    """Puts a robot where it believed to be, row by row.

    It stands on the foot that control believed to stand, leans as its IMU
    says, and has the joints that it measured. Each mind has an odometry of
    its own, which begins midway between the feet: where they stood last in
    that of the mind before.
    """

    def __init__(
        self, rows: PlayedRows, description: RobotDescription
    ) -> None:
        """Take the rows of a robot.

        Args:
            rows: Of a player that moved joints.
            description: Of the robot.

        Raises:
            ConfigurationError: If it is another robot.
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
        self._tilts = _tilts(rows)

    def track(self, gait: GaitSettings, sight: Array) -> Trajectory:
        """Its way, at the samples of the run.

        Args:
            gait: How it walked.
            sight: What it saw, as a track has it.
        """
        columns = self._columns
        sampled = self._rows.sampled
        frames = self._frames()
        minds = columns["mind"]
        made: dict[str, list[Array]] = {}
        for row in sampled.tolist():
            frame = frames[float(minds[row])]
            posture, body = self._stand(row, frame)
            com = body.place + body.axes @ posture.com
            c, s = cos(body.heading), sin(body.heading)
            ahead = gait.zmp_forward * np.array([c, s])
            for name, value in (
                ("com", com),
                ("torso", [*body.place[:2], body.heading]),
                ("place", [*(com[:2] - ahead), body.heading]),
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
                made.setdefault(name, []).append(np.asarray(value))
        arrays = {name: np.array(each) for name, each in made.items()}
        for name in ("place", "torso"):
            arrays[name][:, 2] = np.unwrap(arrays[name][:, 2])
        arrays["qpos"] = arrays["qpos"].astype(np.float32)
        return Trajectory(
            **arrays, landings=self._landings(frames), sight=sight
        )

    def _frames(self) -> dict[float, Pose]:
        """Odometry of each mind in that of the first."""
        minds = self._columns["mind"]
        last = np.append(np.flatnonzero(np.diff(minds)), len(minds) - 1)
        frames, frame = {}, Pose(0.0, 0.0, 0.0)
        for row in last.tolist():
            frames[float(minds[row])] = frame
            posture, body = self._stand(row, frame)
            x, y, _ = (
                body.place + body.axes @ posture.feet.mean(axis=0)
            ).tolist()
            frame = Pose(x, y, body.heading)
        return frames

    def _stand(
        self, row: int, frame: Pose
    ) -> tuple[MeasuredPosture, StandingBody]:
        x, y, heading, side = self._columns["support"][row].tolist()
        posture = self._forward.posture(self._columns["joint_positions"][row])
        support = frame.compose(Pose(x, y, heading))
        roll, pitch = self._tilts[row].tolist()
        foot = 0 if side > 0.0 else 1
        return posture, stand_on(posture, foot, support, (roll, pitch))

    def _qpos(self, row: int, body: StandingBody) -> Array:
        """Place and quaternion of the torso, then all joints."""
        measured = self._columns["joint_positions"][row].tolist()
        known = dict(self._standing)
        known |= dict(zip(self._tree.motors, measured, strict=True))
        for follower, leader in self._tree.followers.items():
            known[follower] = known.get(leader, 0.0)
        joints = [known.get(name, 0.0) for name in self._tree.joints]
        roll, pitch = self._tilts[row].tolist()
        turned = _quaternion(roll, pitch, body.heading)
        return np.array([*body.place, *turned, *joints])

    def _zmp(
        self, row: int, posture: MeasuredPosture, body: StandingBody
    ) -> Array:
        """Center of the foot forces; NaN where there are none."""
        forces = self._columns["foot_forces"][row]
        total = float(forces.sum())
        if not total > PRESSED:
            return np.full(2, np.nan)
        flat = np.column_stack([self._sensors, np.zeros(len(forces))])
        places = np.concatenate(
            [
                posture.feet[i] + flat[4 * i : 4 * i + 4] @ posture.frames[i].T
                for i in range(2)
            ]
        )
        middle = forces @ places / total
        center: Array = (body.place + body.axes @ middle)[:2]
        return center

    def _landings(self, frames: dict[float, Pose]) -> Array:
        begun, minds = self._columns["begun"], self._columns["mind"]
        made = []
        for row in np.flatnonzero(~np.isnan(begun[:, 0])).tolist():
            time, side, x, y, heading, _ = begun[row].tolist()
            landed = frames[float(minds[row])].compose(Pose(x, y, heading))
            made.append([time + float(self._rows.offset[row]), side, *landed])
        return np.array(made, dtype=np.float64).reshape(-1, 5)


def _tilts(rows: PlayedRows) -> Array:
    """Roll and pitch by the IMU, in [rad]. Shape (rows, 2)."""
    own = AttitudeFilter(BELIEF, 0.0, calibration=0.0)
    gyro, force = rows.columns["gyro"], rows.columns["accelerometer"]
    passed = np.diff(rows.times, prepend=0.0).tolist()
    tilts = np.zeros((len(gyro), 2))
    for row, duration in enumerate(passed):
        own.update(gyro[row], force[row], (0.0, 0.0), duration)
        tilts[row] = own.roll, own.pitch
    return tilts


def _quaternion(
    roll: float, pitch: float, yaw: float
) -> tuple[float, float, float, float]:
    """Rotation Rz(yaw) Ry(pitch) Rx(roll) as (w, x, y, z)."""
    (cr, sr), (cp, sp), (cy, sy) = (
        (cos(0.5 * a), sin(0.5 * a)) for a in (roll, pitch, yaw)
    )
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )
