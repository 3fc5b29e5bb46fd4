"""Poses of torso, head and cameras in odometry."""

from dataclasses import dataclass

from ..core.poses import Array, Pose
from ..robots.description import RobotDescription
from ..robots.forward_kinematics import ForwardKinematics, torso_pose_on_foot
from ..robots.head import HeadDescription, Mount
from .camera_model import CameraPose


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


def camera_pose(body: BodyPose, mount: Mount) -> CameraPose:
    """Return the pose of a camera in odometry."""
    position, axes = body.position_head_in_odometry, body.axes_head_in_odometry
    if mount.on_torso:
        position = body.position_torso_in_odometry
        axes = body.axes_torso_in_odometry
    return CameraPose(
        position + axes @ mount.position_in_body,
        axes @ mount.axes_in_body,
        body.pose_torso_in_odometry[:2],
    )
