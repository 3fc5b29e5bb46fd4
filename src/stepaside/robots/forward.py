"""Where CoM and feet are, by the measured joints."""

from typing import NamedTuple

import mujoco
import numpy as np

from ..poses import Array
from .description import RobotDescription

FOOT_FORCES = tuple(
    f"{side}_fsr_{place}"
    for side in "lr"
    for place in ("front_left", "front_right", "rear_left", "rear_right")
)


class MeasuredPosture(NamedTuple):
    """CoM and feet in the torso frame.

    Attributes:
        com: CoM, in [m]. Shape (3,).
        feet: Positions of left and right foot, in [m]. Shape (2, 3).
        frames: Rotations of the foot frames. Shape (2, 3, 3).
    """

    com: Array
    feet: Array
    frames: Array


class ForwardKinematics:
    """CoM and feet of one robot from the angles of its joints.

    Attributes:
        description: The robot.
        mass: Its mass, in [kg].
    """

    def __init__(self, description: RobotDescription) -> None:
        """Compile the robot's model, alone, with the torso at the origin."""
        self.description = description
        self._model = model = description.compile()
        self._data = data = mujoco.MjData(model)
        names = [
            model.joint(model.actuator_trnid[i, 0]).name
            for i in range(model.nu)
        ]
        self._joints = np.array([model.joint(n).qposadr[0] for n in names])
        self._followers = [
            (model.joint(f).qposadr[0], model.joint(leader).qposadr[0])
            for f, leader in description.coupled_joints(model).items()
        ]
        root = model.body(description.torso)
        start = int(model.jnt_qposadr[root.jntadr[0]])
        data.qpos[start : start + 7] = 0, 0, 0, 1, 0, 0, 0
        self._sites = np.array(
            [
                model.site(description.left_foot).id,
                model.site(description.right_foot).id,
            ]
        )
        self._torso = root.id
        self.mass = float(model.body_subtreemass[root.id])

    def posture(self, joint_positions: Array) -> MeasuredPosture:
        """Posture for angles of the actuated joints, in [rad]."""
        data = self._data
        q = data.qpos
        q[self._joints] = joint_positions
        for follower, leader in self._followers:
            q[follower] = q[leader]
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_comPos(self._model, data)
        return MeasuredPosture(
            data.subtree_com[self._torso].copy(),
            data.site_xpos[self._sites],
            data.site_xmat[self._sites].reshape(2, 3, 3),
        )

    def force_sensors(self) -> Array:
        """Places of the foot sensors in the foot frames, in [m].

        Returns:
            Left front-left, front-right, rear-left, rear-right, then right.
            Shape (8, 2).
        """
        model = self._model
        foot = dict(zip("lr", self._sites.tolist(), strict=True))
        return np.array(
            [
                (model.site(name).pos - model.site_pos[foot[name[0]]])[:2]
                for name in FOOT_FORCES
            ]
        )
