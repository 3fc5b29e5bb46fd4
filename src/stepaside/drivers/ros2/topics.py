"""Names of topics and frames, and conversions of poses, for ROS 2 on DDS."""

from math import atan2, cos, sin

from ...core.poses import Pose
from .messages import (
    Point,
    PointStamped,
    PoseMessage,
    PoseStamped,
    Quaternion,
    Vector3,
)

COMMAND = "cmd_vel"
ODOMETRY = "odom"
POINT, POSE = "other", "other_pose"  # opponent, as a point or as a pose
IDEAL = "ideal_sight"  # ground truth of a simulated robot
JOINTS = "joint_states"
IMAGE = "camera/image_raw"
COMPRESSED = f"{IMAGE}/compressed"
CALIBRATION = "camera/camera_info"


def dds_topic(namespace: str, name: str) -> str:
    """Return the name of a topic on DDS, where ROS 2 prefixes ``rt``."""
    return f"rt{namespace}/{name}"


def frame(namespace: str, name: str) -> str:
    """Return the name of a frame of one robot."""
    return f"{namespace}/{name}".lstrip("/")


def yaw(rotation: Quaternion) -> float:
    """Return the yaw angle of a rotation, in [rad]."""
    x, y, z, w = rotation.x, rotation.y, rotation.z, rotation.w
    return atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def yaw_rotation(heading: float) -> Quaternion:
    """Return the rotation about the vertical by a heading, in [rad]."""
    return Quaternion(0.0, 0.0, sin(0.5 * heading), cos(0.5 * heading))


def pose_message(pose: Pose) -> PoseMessage:
    """Convert a planar pose to a message in the same frame."""
    return PoseMessage(Point(pose.x, pose.y), yaw_rotation(pose.theta))


def pose_of(message: PoseMessage) -> Pose:
    """Project the pose of a message onto the floor."""
    point = message.position
    return Pose(point.x, point.y, yaw(message.orientation))


def position_of(message: PointStamped | PoseStamped) -> Point:
    """Return the position in a message."""
    if isinstance(message, PoseStamped):
        return message.pose.position
    return message.point


def vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Vector3:
    """Return a vector message."""
    return Vector3(x, y, z)
