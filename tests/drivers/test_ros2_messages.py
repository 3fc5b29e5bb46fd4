"""Test messages against a reader that we did not write: rosbags' CDR."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

pytest.importorskip("cyclonedds")
rosbags = pytest.importorskip("rosbags.typesys")

from cyclonedds.idl import IdlStruct  # noqa: E402

from stepaside.drivers.ros2 import messages as m  # noqa: E402

STORE = rosbags.get_typestore(rosbags.Stores.ROS2_HUMBLE)
# Of vision_msgs 4, the same in Humble, Jazzy and Kilted.
DEFINITIONS = {
    "ObjectHypothesis": "string class_id\nfloat64 score\n",
    "ObjectHypothesisWithPose": (
        "vision_msgs/ObjectHypothesis hypothesis\n"
        "geometry_msgs/PoseWithCovariance pose\n"
    ),
    "BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n",
    "Detection3D": (
        "std_msgs/Header header\n"
        "vision_msgs/ObjectHypothesisWithPose[] results\n"
        "vision_msgs/BoundingBox3D bbox\nstring id\n"
    ),
    "Detection3DArray": (
        "std_msgs/Header header\nvision_msgs/Detection3D[] detections\n"
    ),
}
for _name, _text in DEFINITIONS.items():
    STORE.register(
        rosbags.get_types_from_msg(_text, f"vision_msgs/msg/{_name}")
    )
STAMP = m.Time(1_700_000_000, 123_456_789)
HEADER = m.Header(STAMP, "nao/odom")
POSE = m.PoseMessage(
    m.Point(1.0, -2.5, 0.25), m.Quaternion(0.1, 0.2, 0.3, 0.9)
)
TWIST = m.Twist(m.Vector3(0.1, 0.2, 0.3), m.Vector3(-0.4, 0.5, -0.6))
MATRIX = tuple(0.5 * i for i in range(36))
MOVED = m.Transform(m.Vector3(1.0, 2.0, 3.0), m.Quaternion(0.0, 0.0, 0.6, 0.8))
GUESS = m.ObjectHypothesisWithPose(
    m.ObjectHypothesis("person", 0.9), m.PoseWithCovariance(POSE, MATRIX)
)
BOX = m.BoundingBox3D(POSE, m.Vector3(0.5, 0.6, 1.7))
FOUND = m.Detection3D(HEADER, [GUESS], BOX, "7")
SAMPLES: dict[str, Any] = {
    "vision_msgs/msg/ObjectHypothesis": GUESS.hypothesis,
    "vision_msgs/msg/ObjectHypothesisWithPose": GUESS,
    "vision_msgs/msg/BoundingBox3D": BOX,
    "vision_msgs/msg/Detection3D": FOUND,
    "vision_msgs/msg/Detection3DArray": m.Detection3DArray(
        HEADER, [FOUND, m.Detection3D(HEADER, [], BOX, "")]
    ),
    "sensor_msgs/msg/RegionOfInterest": m.RegionOfInterest(1, 2, 3, 4, True),
    "sensor_msgs/msg/CameraInfo": m.CameraInfo(
        HEADER,
        240,
        320,
        "plumb_bob",
        [0.1, 0.2, 0.0, 0.0, 0.3],
        MATRIX[:9],
        MATRIX[9:18],
        MATRIX[18:30],
        1,
        2,
        m.RegionOfInterest(),
    ),
    "builtin_interfaces/msg/Time": STAMP,
    "std_msgs/msg/Bool": m.Bool(True),
    "std_msgs/msg/String": m.String("<robot/>"),
    "std_msgs/msg/Header": HEADER,
    "geometry_msgs/msg/Twist": TWIST,
    "geometry_msgs/msg/TwistStamped": m.TwistStamped(HEADER, TWIST),
    "geometry_msgs/msg/PointStamped": m.PointStamped(
        HEADER, m.Point(1.5, -0.5, 0.0)
    ),
    "geometry_msgs/msg/PoseStamped": m.PoseStamped(HEADER, POSE),
    "nav_msgs/msg/Odometry": m.Odometry(
        HEADER,
        "nao/base_link",
        m.PoseWithCovariance(POSE, MATRIX),
        m.TwistWithCovariance(TWIST, MATRIX[::-1]),
    ),
    "tf2_msgs/msg/TFMessage": m.TFMessage(
        [
            m.TransformStamped(HEADER, "a", MOVED),
            m.TransformStamped(m.Header(STAMP, "odd"), "bcd", MOVED),
        ]
    ),
    "rosgraph_msgs/msg/Clock": m.ClockMessage(STAMP),
    "sensor_msgs/msg/JointState": m.JointState(
        HEADER, ["LKneePitch", "R"], [0.5, -0.25], [], [1.0]
    ),
    "sensor_msgs/msg/Image": m.Image(
        HEADER, 2, 3, "rgb8", 0, 9, list(range(18))
    ),
    "sensor_msgs/msg/CompressedImage": m.CompressedImage(
        HEADER, "jpeg", list(range(7))
    ),
}


def leaves(message: Any) -> Iterator[Any]:
    """Everything that a message holds, in order."""
    if is_dataclass(message):
        for field in fields(message):
            if field.name != "__msgtype__":
                yield from leaves(getattr(message, field.name))
    elif isinstance(message, list | tuple | np.ndarray):
        yield len(message)
        for entry in message:
            yield from leaves(entry)
    else:
        yield message


@pytest.mark.parametrize("name", SAMPLES)
def test_rosbags_reads_what_we_write(name: str) -> None:
    ours = SAMPLES[name]
    theirs = STORE.deserialize_cdr(ours.serialize(), name)
    assert list(leaves(theirs)) == list(leaves(ours))


@pytest.mark.parametrize("name", SAMPLES)
def test_we_read_what_rosbags_writes(name: str) -> None:
    ours = SAMPLES[name]
    theirs = STORE.deserialize_cdr(ours.serialize(), name)
    written = bytes(STORE.serialize_cdr(theirs, name))
    read = type(ours).deserialize(written)
    assert list(leaves(read)) == list(leaves(ours))
    assert written == ours.serialize()


@pytest.mark.parametrize("name", SAMPLES)
def test_types_go_by_the_names_that_ros_gives_them_on_dds(name: str) -> None:
    package, kind, message = name.split("/")
    told = SAMPLES[name].__idl__.idl_transformed_typename
    assert told == f"{package}::{kind}::dds_::{message}_"


@pytest.mark.parametrize("time", [0.0, 12.024, 1.7e9 + 0.25, 3.9999999999])
def test_a_time_survives_to_the_nanosecond(time: float) -> None:
    stamp = m.Time.of(time)
    assert 0 <= stamp.nanosec < 10**9
    assert abs(stamp.seconds - time) < 1e-6


def test_no_message_is_left_out_above() -> None:
    kinds = {
        kind
        for kind in vars(m).values()
        if isinstance(kind, type) and issubclass(kind, IdlStruct)
    } - {IdlStruct}
    seen: set[type[Any]] = set()

    def visit(message: Any) -> None:
        if isinstance(message, IdlStruct):
            seen.add(type(message))
            for field in fields(message):
                visit(getattr(message, field.name))
        elif isinstance(message, list):
            for entry in message:
                visit(entry)

    for sample in SAMPLES.values():
        visit(sample)
    assert seen == kinds
