"""Pose of torso and head in odometry, from encoders and torso tilt."""

from dataclasses import dataclass
from math import atan2
from typing import NamedTuple

from ..core.poses import Array, Pose
from ..core.rotations import rotation
from .description import RobotDescription
from .forward_kinematics import ForwardKinematics, MeasuredPosture
from .head import HeadDescription


@dataclass(frozen=True, slots=True, eq=False)
class BodyPose:
    """Torso and head of a body in odometry: positions [m], axes as columns."""

    time: float  # time of the measurement [s]
    pose_torso_in_odometry: Pose
    position_torso_in_odometry: Array
    axes_torso_in_odometry: Array
    position_head_in_odometry: Array
    axes_head_in_odometry: Array
    yaw: float  # measured yaw of the head [rad]
    pitch: float  # measured pitch of the head [rad]


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


class BodyKinematics:
    """Forward kinematics from the stance foot to the head."""

    def __init__(
        self,
        description: RobotDescription,
        head: HeadDescription,
    ) -> None:
        self.forward = ForwardKinematics(description, head.body)
        names = self.forward.tree.motors
        self.yaw, self.pitch = names.index(head.yaw), names.index(head.pitch)

    def pose(
        self,
        time: float,
        joints: Array,
        support: Pose,
        left_supports: bool,
        tilt: tuple[float, float],
    ) -> BodyPose:
        """Return the body pose by encoder angles and pose of the stance."""
        posture = self.forward.posture(joints)
        foot = 0 if left_supports else 1
        place, axes, heading = torso_pose_on_foot(posture, foot, support, tilt)
        return BodyPose(
            time,
            Pose(float(place[0]), float(place[1]), heading),
            place,
            axes,
            place + axes @ posture.position_head_in_torso,
            axes @ posture.axes_head_in_torso,
            float(joints[self.yaw]),
            float(joints[self.pitch]),
        )
