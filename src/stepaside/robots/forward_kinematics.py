"""Poses of CoM, feet, head and torso from measured angles and tilt."""

from math import atan2
from typing import NamedTuple

import numpy as np

from ..core.compilation import bound
from ..core.errors import ModelError
from ..core.poses import Array, Pose
from ..core.rotations import rotation
from .description import REMEDY, RobotDescription
from .joint_tree import joint_tree, place_frames
from .tree_cache import load_tree


class MeasuredPosture(NamedTuple):
    """CoM, feet and head in the torso frame."""

    position_com_in_torso: Array  # position of the CoM [m], (3,)
    # positions of left and right foot [m], (2, 3)
    positions_feet_in_torso: Array
    axes_feet_in_torso: Array  # rotation matrices of both, (2, 3, 3)
    # position of the head [m]; zero without a head, (3,)
    position_head_in_torso: Array = np.zeros(3)
    # rotation matrix of the head; identity without a head, (3, 3)
    axes_head_in_torso: Array = np.eye(3)


class ForwardKinematics:
    """Kinematics of the actuated joints: CoM, left foot, right foot and head.

    Results are in the torso frame, in [m], with axes as columns.
    """

    def __init__(
        self, description: RobotDescription, head: str | None = None
    ) -> None:
        self.description = description
        self.tree = tree = load_tree(description)
        self.mass = tree.mass
        feet = (description.left_foot, description.right_foot)
        self._feet = frames = [tree.sites[name] for name in feet]
        if head is not None:
            frames = [*frames, tree.bodies[head]]
        columns, fixed = tree.moved_by(tree.motors, description.standing)
        self.angles = np.zeros(len(tree.motors))
        self.com = np.empty(3)
        self.places = np.empty((len(frames), 3))
        self.axes = np.empty((len(frames), 3, 3))
        self.run = bound(
            *(place_frames, joint_tree(tree, columns, fixed, frames)),
            *(self.angles, self.com, self.places, self.axes),
        )

    def posture(self, joint_positions: Array) -> MeasuredPosture:
        """Return the posture at angles of the actuated joints, in [rad]."""
        self.evaluate(joint_positions)
        places, axes = self.places.copy(), self.axes.copy()
        head = (places[2], axes[2]) if len(places) > 2 else ()
        return MeasuredPosture(self.com.copy(), places[:2], axes[:2], *head)

    def evaluate(self, angles: Array) -> None:
        """Set the results at angles, in [rad]."""
        self.angles[:] = angles
        self.run()

    def force_sensors(self) -> Array:
        """Return positions (8, 2) [m] of force sensors in the foot frames."""
        corners = []
        for i, name in enumerate(self.description.sensors.feet):
            foot = self._feet[i // 4]
            if name not in self.tree.sites:
                raise ModelError(
                    f"{self.description.name} needs a site {name!r} with a "
                    f"touch sensor under a foot; {REMEDY}"
                )
            offset = np.subtract(self.tree.sites[name].place, foot.place)
            corners.append((np.array(foot.axes).T @ offset)[:2])
        return np.array(corners)


class SpatialTorsoPose(NamedTuple):
    """Spatial pose of a torso in odometry."""

    position_in_odometry: Array  # position of the torso [m], (3,)
    axes_in_odometry: Array  # axes of the torso as columns, (3, 3)
    heading_in_odometry: float  # heading of the torso [rad]


def torso_pose_on_foot(
    posture: MeasuredPosture,
    foot: int,
    support: Pose,
    tilt: tuple[float, float],
) -> SpatialTorsoPose:
    """Return the torso pose that puts foot 0 (left) or 1 at a given pose."""
    lean = rotation(*tilt, 0.0)
    # Torso heading = foot heading - foot yaw relative to the levelled torso.
    ahead = lean @ posture.axes_feet_in_torso[foot, :, 0]
    heading = support.theta - atan2(ahead[1], ahead[0])
    axes = rotation(*tilt, heading)
    place = -(axes @ posture.positions_feet_in_torso[foot])
    place[0] += support.x
    place[1] += support.y
    return SpatialTorsoPose(place, axes, heading)
