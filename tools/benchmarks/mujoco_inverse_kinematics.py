"""Inverse kinematics that uses transforms and Jacobians of MuJoCo.

The former implementation of the package, as a reference for accuracy and
time. Joints at a limit stay in its solve.
"""

from math import atan2, cos, sin

import mujoco
import numpy as np
from scipy.linalg.lapack import dposv

from stepaside.core.errors import ReachError
from stepaside.core.poses import Array
from stepaside.robots.description import RobotDescription
from stepaside.robots.leg_kinematics import BodyReference

DAMPING = 1e-4  # damping squared of the pseudo-inverse; rows in [m] and [rad]
LEAP = 0.3  # maximum joint step in the search for a posture, in [rad]
TOLERANCE = 1e-4  # residual of a converged posture
LOST = 0.5  # residual, in [m] or [rad], above which a reference is refused
LEVEL = (0.0, 0.0)


class MujocoLegs:
    """Floating-base inverse kinematics of one robot.

    Attributes:
        description: The robot.
        joint_names: Actuated joints, in the order of the joint targets.
    """

    def __init__(self, description: RobotDescription, *, tick: float) -> None:
        """Compile the robot's model alone, without a scene.

        Args:
            description: Robot.
            tick: Time between two references, in [s].
        """
        self.description = description
        self._model = model = description.compile()
        self._data = data = mujoco.MjData(model)
        self.joint_names = tuple(
            model.joint(model.actuator_trnid[i, 0]).name
            for i in range(model.nu)
        )
        joints = [model.joint(name) for name in self.joint_names]
        self._targets = np.array([j.qposadr[0] for j in joints])
        followers = description.coupled_joints(model)
        legs = [n for n in description.legs if n not in followers]
        self._legs = np.array([model.joint(n).qposadr[0] for n in legs])
        self._low, self._high = np.array(
            [
                description.working_limits.get(n, model.joint(n).range)
                for n in legs
            ]
        ).T
        speeds = [description.speed_limits[n] for n in legs]
        self._reach = np.array(speeds) * tick
        self._followers = [
            (model.joint(f).qposadr[0], model.joint(leader).qposadr[0])
            for f, leader in followers.items()
        ]
        # Unknowns: 6 of the base, one for each free leg joint.
        self._spread = np.zeros((model.nv, 6 + len(legs)))
        self._spread[:6, :6] = np.eye(6)
        for column, name in enumerate(legs, start=6):
            self._spread[model.joint(name).dofadr[0], column] = 1.0
        for follower, leader in followers.items():
            self._spread[model.joint(follower).dofadr[0]] = self._spread[
                model.joint(leader).dofadr[0]
            ]
        self._left = model.site(description.left_foot).id
        self._right = model.site(description.right_foot).id
        self._torso = model.body(description.torso).id
        self._qpos = data.qpos
        self._points = data.site_xpos
        self._frames = data.site_xmat
        self._torso_frame = data.xmat[self._torso]
        self._com = data.subtree_com[self._torso]
        self._jacobian = np.zeros((15, model.nv))
        self._rows = np.zeros((17, model.nv))
        self._error = np.zeros(17)
        self._damping = DAMPING**2 * np.eye(17)
        for name, angle in description.standing.items():
            data.qpos[model.joint(name).qposadr[0]] = angle

    @property
    def joint_targets(self) -> Array:
        """Angles of the actuated joints, in [rad]. Shape (joints,)."""
        targets: Array = self._qpos[self._targets]
        return targets

    @property
    def posture(self) -> Array:
        """Return position and quaternion of the torso, then all joints."""
        posture: Array = self._qpos.copy()
        return posture

    @property
    def torso_heading(self) -> float:
        """Heading of the torso in the frame of the reference, in [rad]."""
        frame = self._torso_frame
        return atan2(frame[3], frame[0])

    def stand(self, reference: BodyReference) -> Array:
        """Find a posture from scratch.

        Args:
            reference: Reference to reach.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the legs cannot reach it; names the residual.
        """
        if not self._try_stand(reference):
            raise ReachError(f"{self.description.name} cannot stand")
        return self.joint_targets

    def _try_stand(self, reference: BodyReference) -> bool:
        x, y, z = reference.com
        q = self._qpos
        q[:3] = x, y, z
        heading = 0.5 * (reference.left_foot[3] + reference.right_foot[3])
        q[3:7] = cos(0.5 * heading), 0.0, 0.0, sin(0.5 * heading)
        for name, angle in self.description.standing.items():
            q[self._model.joint(name).qposadr[0]] = angle
        for _ in range(60):
            self._step(reference, LEAP)
            if float(np.abs(self._error).max()) < TOLERANCE:
                return True
        return False

    def track(self, reference: BodyReference) -> Array:
        """Follow a reference by one damped step from the last posture.

        A joint at a limit of its range or speed stays there; the other joints
        minimise the error.

        Args:
            reference: Reference of this tick.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the residual is above the limit; names it.
        """
        self._step(reference, self._reach)
        error = self._error
        if error.max() > LOST or error.min() < -LOST:
            raise ReachError(f"{self.description.name} cannot follow")
        return self.joint_targets

    def _step(self, reference: BodyReference, reach: Array | float) -> None:
        """Take one damped Newton step; store the error before it.

        No joint moves by more than ``reach``, in [rad]: near a straight knee
        an unlimited step would reach the other branch of the leg.
        """
        model, data, q = self._model, self._data, self._qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        jacobian = self._jacobian
        left, right = self._left, self._right
        mujoco.mj_jacSite(model, data, jacobian[0:3], jacobian[3:6], left)
        mujoco.mj_jacSite(model, data, jacobian[6:9], jacobian[9:12], right)
        mujoco.mj_jacSubtreeCom(model, data, jacobian[12:15], self._torso)
        rows = self._rows
        rows[:15] = jacobian
        frame = self._torso_frame.reshape(3, 3)
        rows[15:17, 3:6] = frame[:2]
        error = self._error
        error[0:3] = reference.left_foot[:3] - self._points[left]
        error[3:6] = _turn(self._frames[left], reference.left_foot[3])
        error[6:9] = reference.right_foot[:3] - self._points[right]
        error[9:12] = _turn(self._frames[right], reference.right_foot[3])
        if reference.left_tilt != LEVEL or reference.right_tilt != LEVEL:
            yaw = reference.left_foot[3]
            error[3:5] += _lean(reference.left_tilt, yaw)
            yaw = reference.right_foot[3]
            error[9:11] += _lean(reference.right_tilt, yaw)
        error[12:15] = reference.com - self._com
        error[15] = frame[1, 2]
        error[16] = -frame[0, 2]
        j = rows @ self._spread
        # J' (J J' + damping)^-1 e
        # The matrix is positive definite; call LAPACK directly to save checks.
        _, weights, _ = dposv(j @ j.T + self._damping, error)
        step = j.T @ weights
        joints = step[6:]
        np.minimum(joints, reach, out=joints)
        np.maximum(joints, -reach, out=joints)
        mujoco.mj_integratePos(model, q, self._spread @ step, 1.0)
        legs = q[self._legs]
        np.minimum(legs, self._high, out=legs)
        np.maximum(legs, self._low, out=legs)
        q[self._legs] = legs
        for follower, leader in self._followers:
            q[follower] = q[leader]


def _lean(tilt: tuple[float, float], yaw: float) -> tuple[float, float]:
    """Return roll and pitch about a heading as a small rotation, in [rad]."""
    c, s = cos(yaw), sin(yaw)
    return c * tilt[0] - s * tilt[1], s * tilt[0] + c * tilt[1]


def _turn(frame: Array, yaw: float) -> tuple[float, float, float]:
    """Return the small rotation, in [rad], that levels a frame at a yaw angle.

    Half the sum of cross products of the axes and their desired directions.
    """
    m00, m01, m02, m10, m11, m12, m20, m21, _ = frame.tolist()
    c, s = cos(yaw), sin(yaw)
    return (
        0.5 * (m12 - m20 * s - m21 * c),
        0.5 * (m20 * c - m21 * s - m02),
        0.5 * ((m00 + m11) * s + (m01 - m10) * c),
    )
