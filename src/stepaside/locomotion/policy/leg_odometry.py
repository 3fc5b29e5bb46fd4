"""Odometry of a walking robot from its loaded soles and its gyro."""

from math import atan2, cos, isnan, sin

import numpy as np

from ...core.compilation import bound, compiled
from ...core.poses import Array, Pose
from ...core.rotations import rotation
from ...perception.measurement import RobotState
from ...planning import Foot
from ...robots.forward_kinematics import ForwardKinematics

SMOOTHING = 0.1  # time constant of the velocity, in [s]: a few readings
# Height above the lowest corner at which one carries 1/e of its load, in [m]:
# soles give way by millimetres, and are lifted by centimetres.
CONTACT = 0.001
# Share by which a corner counts in the interval after it has touched down: it
# still slides ahead then. Without it true motion is 0.8 % longer than the
# odometry on the circles of G1, T1 and K1, with it 0.2 % (0: 0.2 % too).
LANDED = 0.1


@compiled
def note(
    com: Array,
    feet: Array,
    axes: Array,
    corners: Array,
    forces: Array,
    given: Array,
    points: Array,
    loads: Array,
    velocity: Array,
    pose: Array,
    moved: Array,
) -> None:
    """Advance the odometry by one reading; see :class:`LegOdometry`."""
    roll, pitch, turn, duration = given[0], given[1], given[2], given[3]
    sr, cr, sp, cp = sin(roll), cos(roll), sin(pitch), cos(pitch)
    c, s = cos(0.5 * turn), sin(0.5 * turn)
    load, u, v, w = 0.0, 0.0, 0.0, 0.0
    ahead, left = 0.0, 0.0
    for k in range(9):
        x, y, z = com[0], com[1], com[2]
        if k < 8:
            i = 0 if k < 4 else 1
            a, b = corners[k, 0], corners[k, 1]
            x = feet[i, 0] + axes[i, 0, 0] * a + axes[i, 0, 1] * b
            y = feet[i, 1] + axes[i, 1, 0] * a + axes[i, 1, 1] * b
            z = feet[i, 2] + axes[i, 2, 0] * a + axes[i, 2, 1] * b
        xl = cp * x + sp * sr * y + sp * cr * z
        yl = cr * y - sr * z
        zl = cp * sr * y - sp * x + cp * cr * z
        dx = xl * c - yl * s - (points[k, 0] * c + points[k, 1] * s)
        dy = xl * s + yl * c - (points[k, 1] * c - points[k, 0] * s)
        dz = zl - points[k, 2]
        points[k, 0], points[k, 1], points[k, 2] = xl, yl, zl
        if k < 8:
            force = max(forces[k], 0.0)
            weight = min(loads[0, k], force)
            weight = min(weight, loads[1, k] + LANDED * weight)
            load += weight
            u += weight * dx
            v += weight * dy
            w += weight * dz
            loads[1, k] = loads[0, k]
            loads[0, k] = force
        else:
            ahead, left = dx, dy
    if load > 0.0:
        u, v, w = -given[5] * u / load, -given[6] * v / load, -w / load
        moved[0], moved[1] = u + ahead, v + left
    else:
        u, v = velocity[0] * duration, velocity[1] * duration
        w = velocity[2] * duration
        moved[0], moved[1] = u, v
    share = min(1.0, duration / given[4])
    velocity[0] += share * (u / duration - velocity[0])
    velocity[1] += share * (v / duration - velocity[1])
    velocity[2] += share * (w / duration - velocity[2])
    c, s = cos(pose[2] + 0.5 * turn), sin(pose[2] + 0.5 * turn)
    pose[0] += c * moved[0] - s * moved[1]
    pose[1] += s * moved[0] + c * moved[1]
    pose[2] += turn
    moved[2] = turn


class LegOdometry:
    """Pose of the CoM over the floor, from the corners that carry it.

    A corner of a sole that is loaded at two readings does not move between
    them. The torso moves by the opposite of the motion of these corners in its
    frame, the mean over all eight by the smaller of both loads; one that just
    landed counts by a tenth, as a foot slides then. Feet that slip in spite of
    this change the motion by a ratio that is measured. Without force sensors
    the lowest corners count as loaded. The CoM moves as the joints say in
    addition.
    """

    def __init__(
        self,
        forward: ForwardKinematics,
        joint_positions: Array,
        ratio: tuple[float, float] = (1.0, 1.0),
    ) -> None:
        """Begin at the origin.

        ``joint_positions``: Initial joint angles, in [rad]. Shape (joints,).
        """
        self._forward = forward
        forward.evaluate(joint_positions)
        self._tilt = 0.0, 0.0
        self.moved: Array = np.zeros(3)  # ahead, left [m], turn [rad]
        self.velocity: Array = np.zeros(3)  # [m/s] (3,)
        self._pose, self._loads = np.zeros(3), np.zeros((2, 8))
        self._com, self._forces = forward.com, np.zeros(8)
        self._feet, self._axes = forward.places[:2], forward.axes[:2]
        # Roll, pitch, turn, duration, smoothing of the velocity, ratio.
        self._given = np.array([0.0, 0.0, 0.0, 0.0, SMOOTHING, *ratio])
        self._corners = np.ascontiguousarray(forward.force_sensors())
        noted = bound(
            *(note, self._com, self._feet, self._axes),
            *(self._corners, self._forces, self._given),
            *(np.zeros((9, 3)), self._loads),
            *(self.velocity, self._pose, self.moved),
        )
        self.loops = forward.run, noted

    @property
    def pose(self) -> Pose:
        """Place of the CoM in odometry, and heading, which counts turns."""
        return Pose(*self._pose.tolist())

    @property
    def stance(self) -> tuple[Pose, Foot]:
        """Pose in odometry of the foot with the greater load, and its side.

        Its sole is taken for level.
        """
        left, right = self._loads[0].reshape(2, 4).sum(axis=1).tolist()
        side = Foot.LEFT if left >= right else Foot.RIGHT
        i = 0 if side is Foot.LEFT else 1
        level = rotation(*self._tilt, 0.0)
        ahead = level @ self._axes[i, :, 0]
        place = level @ (self._feet[i] - self._com)
        yaw = atan2(ahead[1], ahead[0])
        return self.pose.compose(Pose(place[0], place[1], yaw)), side

    def take(
        self,
        measurement: RobotState,
        tilt: tuple[float, float],
        turn: float,
        duration: float,
    ) -> None:
        """Take a reading, before :attr:`loops` run.

        ``turn`` is about the vertical since the last reading, in [rad].
        """
        self._forward.angles[:] = measurement.joint_positions
        self._tilt, given = tilt, self._given
        self._forces[:] = measurement.foot_forces
        if isnan(sum(self._forces.tolist())):
            self._forces[:] = self._loads_by_height()
        given[0], given[1] = tilt
        given[2], given[3] = turn, duration

    def _loads_by_height(self) -> Array:
        """Return weights of the corners of both soles by their height."""
        self._forward.run()
        up = rotation(*self._tilt, 0.0)[2]
        height = self._feet @ up
        corners = self._corners.reshape(2, 4, 2)
        slopes = up @ self._axes[:, :, :2]
        heights = height[:, None] + (corners @ slopes[:, :, None])[..., 0]
        above = heights.reshape(8) - heights.min()
        weights: Array = np.exp(-above / CONTACT)
        return weights
