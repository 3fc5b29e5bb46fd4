"""Names of topics and frames, and conversions of poses, for ROS 2 on DDS."""

from collections.abc import Mapping, Sequence
from math import cos, hypot, sin
from types import MappingProxyType

import numpy as np

from ...core.errors import ConfigurationError
from ...core.poses import Pose, rotation_of_quaternion
from .messages import (
    Detection3DArray,
    Point,
    PointStamped,
    PoseMessage,
    PoseStamped,
    Quaternion,
    Vector3,
)
from .namespaces import parse_namespace

COMMAND = "cmd_vel"
ODOMETRY = "odom"
POINT, POSE = "other", "other_pose"  # opponent, as a point or as a pose
DETECTIONS = "detections"  # of another program, one of which is the opponent
IDEAL = "ideal_sight"  # ground truth of a simulated robot
JOINTS = "joint_states"
IMAGE = "camera/image_raw"
COMPRESSED = f"{IMAGE}/compressed"
CALIBRATION = "camera/camera_info"
DESCRIPTION = "robot_description"  # URDF


REMAPPED = (ODOMETRY, COMMAND, POINT, POSE, DETECTIONS)
NO_REMAPPING: Mapping[str, str] = MappingProxyType({})


def ros_topic(
    namespace: str, name: str, remapping: Mapping[str, str] = NO_REMAPPING
) -> str:
    """Return the name of a robot's topic in ROS 2.

    Args:
        namespace: Namespace of the robot, with a leading slash; or empty.
        name: Name in it.
        remapping: Topics with another name, by the name in the namespace.
    """
    return remapping.get(name, f"{namespace}/{name}")


def dds_topic(
    namespace: str, name: str, remapping: Mapping[str, str] = NO_REMAPPING
) -> str:
    """Return the name of a topic on DDS, where ROS 2 prefixes ``rt``."""
    return f"rt{ros_topic(namespace, name, remapping)}"


def parse_remapping(rules: Sequence[str]) -> dict[str, str]:
    """Parse rules like ``cmd_vel:=/nav/cmd_vel``.

    Returns:
        Topics with a leading slash, by name.

    Raises:
        ConfigurationError: If a rule is invalid, or a name occurs twice.
    """
    found: dict[str, str] = {}
    for rule in rules:
        name, separator, topic = rule.partition(":=")
        if name not in REMAPPED or not separator or not topic.strip("/"):
            raise ConfigurationError(
                f"remap must be NAME:=/TOPIC with NAME one of "
                f"{', '.join(REMAPPED)}, got {rule!r}"
            )
        if name in found:
            raise ConfigurationError(f"remap has two topics for {name}")
        found[name] = parse_namespace(topic)
    return found


def nearest_detection(
    message: Detection3DArray, kind: str
) -> tuple[float, float] | None:
    """Return the nearest detected object.

    Args:
        message: Detections.
        kind: Class of the objects that count; empty for any. An object
            counts if the hypothesis with the highest score says so.

    Returns:
        Position x and y of the center of its box, in [m], in the frame of
        the message; None if there is no such object.
    """
    found = []
    for detection in message.detections:
        if kind:
            scored = [each.hypothesis for each in detection.results]
            best = max(scored, key=lambda each: each.score, default=None)
            if best is None or best.class_id != kind:
                continue
        center = detection.bbox.center.position
        found.append((center.x, center.y))
    return min(found, key=lambda place: hypot(*place), default=None)


def frame(namespace: str, name: str) -> str:
    """Return the name of a frame of one robot."""
    return f"{namespace}/{name}".lstrip("/")


def yaw_rotation(heading: float) -> Quaternion:
    """Return the rotation about the vertical by a heading, in [rad]."""
    return Quaternion(0.0, 0.0, sin(0.5 * heading), cos(0.5 * heading))


def rotation_message(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the rotation Rz(yaw) Ry(pitch) Rx(roll), angles in [rad]."""
    cr, sr = cos(0.5 * roll), sin(0.5 * roll)
    cp, sp = cos(0.5 * pitch), sin(0.5 * pitch)
    cy, sy = cos(0.5 * yaw), sin(0.5 * yaw)
    return Quaternion(
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def pose_message(pose: Pose) -> PoseMessage:
    """Convert a planar pose to a message in the same frame."""
    return PoseMessage(Point(pose.x, pose.y), yaw_rotation(pose.theta))


def pose_of(message: PoseMessage) -> Pose:
    """Project the pose of a message onto the floor.

    The heading is NaN if the rotation is zero or not finite.
    """
    point, q = message.position, message.orientation
    turn = rotation_of_quaternion(q.x, q.y, q.z, q.w)
    return Pose(point.x, point.y, float(np.arctan2(turn[1, 0], turn[0, 0])))


def position_of(message: PointStamped | PoseStamped) -> Point:
    """Return the position in a message."""
    if isinstance(message, PoseStamped):
        return message.pose.position
    return message.point


def vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Vector3:
    """Return a vector message."""
    return Vector3(x, y, z)
