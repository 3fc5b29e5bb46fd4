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
    """Torso and head of a body in odometry, measured at one instant.

    Positions are in [m], axes are columns. Shapes (3,), (3, 3).

    Attributes:
        time: Time of the measurement, in [s].
        pose_torso_in_odometry: Planar pose of the torso.
        position_torso_in_odometry: Position of the torso.
        axes_torso_in_odometry: Axes of the torso.
        position_head_in_odometry: Position of the head.
        axes_head_in_odometry: Axes of the head.
        yaw: Measured yaw of the head, in [rad].
        pitch: Measured pitch of the head, in [rad].
    """

    time: float
    pose_torso_in_odometry: Pose
    position_torso_in_odometry: Array
    axes_torso_in_odometry: Array
    position_head_in_odometry: Array
    axes_head_in_odometry: Array
    yaw: float
    pitch: float


class SpatialTorsoPose(NamedTuple):
    """Spatial pose of a torso in odometry.

    Attributes:
        position_in_odometry: Position of the torso, in [m]. Shape (3,).
        axes_in_odometry: Axes of the torso as columns. Shape (3, 3).
        heading_in_odometry: Heading of the torso, in [rad].
    """

    position_in_odometry: Array
    axes_in_odometry: Array
    heading_in_odometry: float


def torso_pose_on_foot(
    posture: MeasuredPosture,
    foot: int,
    support: Pose,
    tilt: tuple[float, float],
) -> SpatialTorsoPose:
    """Return the torso pose that puts the stance foot at a given pose.

    The stance foot is 0 (left) or 1 (right); tilt is roll and pitch of the
    torso, in [rad].
    """
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
    """Forward kinematics from the stance foot to the head.

    Attributes:
        forward: Kinematics of the measured joints.
        yaw: Index of the head yaw among the joints.
        pitch: Index of the head pitch among the joints.
    """

    def __init__(
        self,
        description: RobotDescription,
        head: HeadDescription,
    ) -> None:
        """Look up the head joints."""
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
        """Return the body pose given the pose of the stance foot.

        Args:
            time: Time of the measurement, in [s].
            joints: Encoder angles, in [rad]. Shape (joints,).
            support: Pose of the stance foot in odometry.
            left_supports: Whether the stance foot is the left one.
            tilt: Roll and pitch of the torso, in [rad].
        """
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
