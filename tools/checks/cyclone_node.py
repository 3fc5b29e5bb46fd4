"""Node on CycloneDDS 0.10, the middleware of ROS 2 Humble, without ROS.

Humble has no wheels on PyPI. This stands in for ``rclpy`` and its messages in
``ros2_peer.py``: the same names of topics and types on DDS, the same quality
of service, rosbags' definitions of messages of Humble (by
``stepaside.drivers.ros2_dds``), on the loopback interface as with
``ROS_LOCALHOST_ONLY=1``. Its Python needs ``cyclonedds==0.10.2``, numpy and
rosbags.
"""

import os
import sys
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from time import monotonic, sleep, time
from types import ModuleType
from typing import Any

LOCALHOST = """<CycloneDDS><Domain><General><Interfaces><NetworkInterface
address="127.0.0.1"/></Interfaces></General></Domain></CycloneDDS>"""
PAUSE = 0.002  # between two looks for messages, in [s]
NAMES = {
    "geometry_msgs.msg": ("PointStamped", "Twist", "TwistStamped"),
    "nav_msgs.msg": ("Odometry",),
    "rosgraph_msgs.msg": ("Clock",),
    "sensor_msgs.msg": (
        *("CameraInfo", "CompressedImage", "Image", "JointState"),
    ),
    "std_msgs.msg": ("String",),
}


def default(kind: Any) -> Any:
    """Return the default value of a type of a field."""
    if is_dataclass(kind):
        return kind(*(default(field.type) for field in fields(kind)))  # type: ignore[operator]
    if kind is str:
        return ""
    (detail,) = kind.__metadata__  # "float64", or a sequence or array
    if isinstance(detail, str):
        return 0.0 if detail.startswith("float") else 0
    return [0.0] * getattr(detail, "length", 0)


class MessageKind:
    """Type of messages, which are made as those of ROS 2 are."""

    def __init__(self, kind: Any) -> None:
        """Wrap a DDS type."""
        self.kind = kind

    def __call__(self, **values: Any) -> Any:
        """Return a message with some values; the others are defaults."""
        message = default(self.kind)
        for name, value in values.items():
            setattr(message, name, value)
        return message


class Quality:
    """Quality of service, as ``rclpy.qos.QoSProfile``."""

    def __init__(self, depth: int, durability: str) -> None:
        """Note it."""
        self.depth, self.latched = depth, durability == "transient local"


class Durability:
    """Names of durabilities, as ``rclpy.qos.DurabilityPolicy``."""

    TRANSIENT_LOCAL = "transient local"


class Writer:
    """Publisher."""

    def __init__(self, writer: Any) -> None:
        """Wrap a DDS writer."""
        self.publish = writer.write


class Node:
    """Node with the methods that the peer uses."""

    def __init__(self, namespace: str) -> None:
        """Join the domain of the environment."""
        from cyclonedds.domain import DomainParticipant

        os.environ["CYCLONEDDS_URI"] = LOCALHOST
        number = int(os.environ.get("ROS_DOMAIN_ID", "0"))
        self.participant = DomainParticipant(number)
        self.namespace = namespace
        self.readers: list[tuple[Any, Callable[[Any], None]]] = []
        self.timers: list[tuple[float, Callable[[], None]]] = []
        self.due = monotonic()

    def topic(self, kind: MessageKind, name: str) -> Any:
        """Return a topic of DDS by its name in ROS 2."""
        from cyclonedds.topic import Topic

        name = name if name[0] == "/" else f"{self.namespace}/{name}"
        return Topic(self.participant, f"rt{name}", kind.kind)

    @staticmethod
    def quality(depth: int, latched: bool) -> Any:
        """Return the quality of service of ROS 2's default profile."""
        from cyclonedds.core import Policy, Qos

        own = [Policy.Reliability.Reliable(10**9)]
        own += [Policy.Durability.TransientLocal] if latched else []
        return Qos(*own, Policy.History.KeepLast(depth))

    def create_publisher(self, kind: Any, name: str, depth: int) -> Writer:
        """Return a publisher."""
        from cyclonedds.pub import DataWriter

        topic, quality = self.topic(kind, name), self.quality(depth, False)
        return Writer(DataWriter(self.participant, topic, qos=quality))

    def create_subscription(
        self, kind: Any, name: str, take: Callable[[Any], None], qos: Any
    ) -> None:
        """Call a function with each message."""
        from cyclonedds.sub import DataReader

        latched = isinstance(qos, Quality) and qos.latched
        quality = self.quality(10, latched)
        topic = self.topic(kind, name)
        reader = DataReader(self.participant, topic, qos=quality)
        self.readers.append((reader, take))

    def create_timer(self, period: float, call: Callable[[], None]) -> None:
        """Call a function at a period, in [s]."""
        self.timers.append((period, call))

    def get_clock(self) -> "Node":
        """Return this object as its clock."""
        return self

    def now(self) -> "Node":
        """Return this object as the time now."""
        return self

    def to_msg(self) -> Any:
        """Return the time."""
        from stepaside.drivers.ros2_dds import stamp_of

        return stamp_of(time())

    def spin(self, timeout: float) -> None:
        """Take messages and call timers for a time, in [s]."""
        end = monotonic() + timeout
        while monotonic() < end:
            for reader, take in self.readers:
                for sample in reader.take(N=16):
                    if sample.sample_info.valid_data:
                        take(sample)
            for period, call in self.timers:
                if monotonic() >= self.due:
                    self.due = monotonic() + period
                    call()
            sleep(PAUSE)

    def destroy_node(self) -> None:
        """Leave."""
        self.readers.clear()


def install() -> None:
    """Install the stand-ins as modules of the names of ROS 2."""
    from cyclonedds.idl import types

    setattr(types, "byte", types.uint8)  # noqa: B010 (of version 0.10)
    from stepaside.drivers.ros2_dds import message_type

    for module, names in NAMES.items():
        made = ModuleType(module)
        for name in names:
            kind = message_type(f"{module.replace('.', '/')}/{name}")
            setattr(made, name, MessageKind(kind))
        sys.modules[module] = made
    rclpy, qos = ModuleType("rclpy"), ModuleType("rclpy.qos")
    vars(qos).update(QoSProfile=Quality, DurabilityPolicy=Durability)
    vars(rclpy).update(
        init=lambda: None,
        shutdown=lambda: None,
        create_node=lambda name, namespace: Node(namespace),
        spin_once=lambda node, timeout_sec: node.spin(timeout_sec),
    )
    sys.modules.update({"rclpy": rclpy, "rclpy.qos": qos})
