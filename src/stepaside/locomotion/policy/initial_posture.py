"""Posture in which a robot with a walking policy begins."""

from collections.abc import Mapping

import numpy as np

from ...core.poses import Array
from ...robots.forward_kinematics import ForwardKinematics


class InitialPosture:
    """Upright posture with given joint angles and the soles on the floor.

    Attributes:
        joint_names: Names of the actuated joints.
        joint_targets: Their angles, in [rad]. Shape (joints,).
        posture: Position and quaternion of the torso in odometry, then the
            angles of all joints. Shape (7 + joints,).
    """

    def __init__(
        self, forward: ForwardKinematics, angles: Mapping[str, float]
    ) -> None:
        """Stand with the feet on either side of the odometry's origin.

        Args:
            forward: Kinematics of the robot.
            angles: Joint angles, in [rad]; those of joints that are absent
                are of the standing posture of the description.
        """
        tree = forward.tree
        known = {**forward.description.standing, **angles}
        self.joint_names = tree.motors
        self.joint_targets: Array = np.array(
            [known.get(name, 0.0) for name in tree.motors]
        )
        feet = forward.posture(self.joint_targets).positions_feet_in_torso
        middle = feet.mean(axis=0)
        leaders = tree.followers
        joints = (known.get(leaders.get(n, n), 0.0) for n in tree.joints)
        place = (-middle[0], -middle[1], -feet[:, 2].min())
        self.posture: Array = np.array([*place, 1.0, 0.0, 0.0, 0.0, *joints])
