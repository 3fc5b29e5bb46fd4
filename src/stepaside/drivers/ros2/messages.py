"""Standard ROS 2 messages as DDS types.

Names and order of the fields are those of ROS 2's interface definitions,
which determine the wire format: do not reorder fields. Its ``uint8`` is
``byte`` here, as in the IDL that ROS 2 generates: CycloneDDS 0.10, of ROS 2
Humble, fails on the description of ``uint8``.
"""

from dataclasses import dataclass

from ...core.errors import ConfigurationError

try:
    from cyclonedds.idl import IdlStruct
    from cyclonedds.idl.types import (
        array,
        byte,
        float64,
        int32,
        sequence,
        uint32,
    )
except ImportError as error:
    raise ConfigurationError(
        "ROS 2 topics need CycloneDDS: pip install 'stepaside[ros2]'"
    ) from error

MATRIX = 36  # entries of a 6 by 6 covariance


@dataclass
class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    """Time stamp."""

    sec: int32
    nanosec: uint32

    @classmethod
    def of(cls, time: float) -> "Time":
        """Convert a time in [s]."""
        nanoseconds = round(time * 1e9)
        return cls(nanoseconds // 10**9, nanoseconds % 10**9)

    @property
    def seconds(self) -> float:
        """Time, in [s]."""
        return float(self.sec + 1e-9 * self.nanosec)


@dataclass
class Header(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    """Time stamp and frame of a message."""

    stamp: Time
    frame_id: str


@dataclass
class Bool(IdlStruct, typename="std_msgs.msg.dds_.Bool_"):
    """Truth value."""

    data: bool


@dataclass
class String(IdlStruct, typename="std_msgs.msg.dds_.String_"):
    """Text."""

    data: str


@dataclass
class Vector3(IdlStruct, typename="geometry_msgs.msg.dds_.Vector3_"):
    """Vector in three dimensions."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
class Point(IdlStruct, typename="geometry_msgs.msg.dds_.Point_"):
    """Position, in [m]."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
class Quaternion(IdlStruct, typename="geometry_msgs.msg.dds_.Quaternion_"):
    """Rotation as a unit quaternion."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


@dataclass
class PoseMessage(IdlStruct, typename="geometry_msgs.msg.dds_.Pose_"):
    """Position and orientation."""

    position: Point
    orientation: Quaternion


@dataclass
class Twist(IdlStruct, typename="geometry_msgs.msg.dds_.Twist_"):
    """Linear and angular velocity, in [m/s] and [rad/s]."""

    linear: Vector3
    angular: Vector3


@dataclass
class TwistStamped(IdlStruct, typename="geometry_msgs.msg.dds_.TwistStamped_"):
    """Velocity with header."""

    header: Header
    twist: Twist


@dataclass
class PointStamped(IdlStruct, typename="geometry_msgs.msg.dds_.PointStamped_"):
    """Position with header."""

    header: Header
    point: Point


@dataclass
class PoseStamped(IdlStruct, typename="geometry_msgs.msg.dds_.PoseStamped_"):
    """Pose with header."""

    header: Header
    pose: PoseMessage


@dataclass
class PoseWithCovariance(
    IdlStruct, typename="geometry_msgs.msg.dds_.PoseWithCovariance_"
):
    """Pose with covariance."""

    pose: PoseMessage
    covariance: array[float64, MATRIX]


@dataclass
class TwistWithCovariance(
    IdlStruct, typename="geometry_msgs.msg.dds_.TwistWithCovariance_"
):
    """Velocity with covariance."""

    twist: Twist
    covariance: array[float64, MATRIX]


@dataclass
class ObjectHypothesis(
    IdlStruct, typename="vision_msgs.msg.dds_.ObjectHypothesis_"
):
    """Class of a detected object, with its score."""

    class_id: str
    score: float64


@dataclass
class ObjectHypothesisWithPose(
    IdlStruct, typename="vision_msgs.msg.dds_.ObjectHypothesisWithPose_"
):
    """Class of a detected object, with its pose."""

    hypothesis: ObjectHypothesis
    pose: PoseWithCovariance


@dataclass
class BoundingBox3D(IdlStruct, typename="vision_msgs.msg.dds_.BoundingBox3D_"):
    """Box around a detected object."""

    center: PoseMessage
    size: Vector3


@dataclass
class Detection3D(IdlStruct, typename="vision_msgs.msg.dds_.Detection3D_"):
    """Detected object."""

    header: Header
    results: sequence[ObjectHypothesisWithPose]
    bbox: BoundingBox3D
    id: str


@dataclass
class Detection3DArray(
    IdlStruct, typename="vision_msgs.msg.dds_.Detection3DArray_"
):
    """Objects detected at one instant."""

    header: Header
    detections: sequence[Detection3D]


@dataclass
class Odometry(IdlStruct, typename="nav_msgs.msg.dds_.Odometry_"):
    """Estimated pose and velocity of a robot."""

    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance


@dataclass
class Transform(IdlStruct, typename="geometry_msgs.msg.dds_.Transform_"):
    """Translation and rotation between two frames."""

    translation: Vector3
    rotation: Quaternion


@dataclass
class TransformStamped(
    IdlStruct, typename="geometry_msgs.msg.dds_.TransformStamped_"
):
    """Transform with header."""

    header: Header
    child_frame_id: str
    transform: Transform


@dataclass
class TFMessage(IdlStruct, typename="tf2_msgs.msg.dds_.TFMessage_"):
    """List of transforms, as on ``/tf``."""

    transforms: sequence[TransformStamped]


@dataclass
class ClockMessage(IdlStruct, typename="rosgraph_msgs.msg.dds_.Clock_"):
    """Simulated time, as on ``/clock``."""

    clock: Time


@dataclass
class JointState(IdlStruct, typename="sensor_msgs.msg.dds_.JointState_"):
    """Joint angles, in [rad]."""

    header: Header
    name: sequence[str]
    position: sequence[float64]
    velocity: sequence[float64]
    effort: sequence[float64]


@dataclass
class Image(IdlStruct, typename="sensor_msgs.msg.dds_.Image_"):
    """Uncompressed image."""

    header: Header
    height: uint32
    width: uint32
    encoding: str
    is_bigendian: byte
    step: uint32
    data: sequence[byte]


@dataclass
class CompressedImage(
    IdlStruct, typename="sensor_msgs.msg.dds_.CompressedImage_"
):
    """Image as JPEG or PNG."""

    header: Header
    format: str
    data: sequence[byte]


@dataclass
class RegionOfInterest(
    IdlStruct, typename="sensor_msgs.msg.dds_.RegionOfInterest_"
):
    """Part of an image; all zero for the whole image."""

    x_offset: uint32 = 0
    y_offset: uint32 = 0
    height: uint32 = 0
    width: uint32 = 0
    do_rectify: bool = False


@dataclass
class CameraInfo(IdlStruct, typename="sensor_msgs.msg.dds_.CameraInfo_"):
    """Calibration of a camera."""

    header: Header
    height: uint32
    width: uint32
    distortion_model: str
    d: sequence[float64]
    k: array[float64, 9]
    r: array[float64, 9]
    p: array[float64, 12]
    binning_x: uint32
    binning_y: uint32
    roi: RegionOfInterest
