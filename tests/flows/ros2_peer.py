"""A robot on ROS 2 topics of its own: nothing in it is the project's.

Messages are those of rosbags' store of ROS 2's definitions, written and read
by CycloneDDS.
"""

import os
from functools import cache
from math import cos, sin
from threading import Event, Thread
from time import monotonic
from typing import Any

import pytest

pytest.importorskip("cyclonedds")
pytest.importorskip("rosbags")

from cyclonedds.core import Policy, Qos  # noqa: E402
from cyclonedds.domain import DomainParticipant  # noqa: E402
from cyclonedds.idl import make_idl_struct, types  # noqa: E402
from cyclonedds.pub import DataWriter  # noqa: E402
from cyclonedds.sub import DataReader  # noqa: E402
from cyclonedds.topic import Topic  # noqa: E402
from rosbags.interfaces import Nodetype  # noqa: E402
from rosbags.typesys import Stores, get_typestore  # noqa: E402

STORE = get_typestore(Stores.ROS2_HUMBLE)
DOMAIN = 20 + os.getpid() % 200  # of the tests of this process
PLAIN = {"bool": bool, "uint8": types.byte, "string": str} | {
    name: getattr(types, name)
    for name in ("int32", "uint32", "float32", "float64")
}
# As ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST has it.
LOCALHOST = """<CycloneDDS><Domain><General><Interfaces>
<NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery>
<Peers><Peer address="127.0.0.1"/></Peers>
<ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>63</MaxAutoParticipantIndex>
</Discovery></Domain></CycloneDDS>"""
RELIABLE = Qos(Policy.Reliability.Reliable(0), Policy.History.KeepLast(1))
PERIOD = 0.04  # of its odometry, in [s]


@cache
def kind(name: str) -> Any:
    """Return the DDS type of a ROS 2 message."""
    package, _, short = name.split("/")
    fields = {n: _type(d) for n, d in STORE.fielddefs[name][1]}
    typename = f"{package}.msg.dds_.{short}_"
    return make_idl_struct(short, typename, fields, dataclassify=True)


def _type(description: Any) -> Any:
    form, about = description
    if form == Nodetype.BASE:
        return PLAIN[about[0]]
    if form == Nodetype.NAME:
        return kind(about)
    inner, count = _type(about[0]), about[1]
    if form == Nodetype.ARRAY:
        return types.array[inner, count]
    return types.sequence[inner]


def make(name: str, *values: Any) -> Any:
    """Return a message of a package's type, such as std_msgs/Bool."""
    package, _, short = name.partition("/")
    return kind(f"{package}/msg/{short}")(*values)


def header(time: float, frame: str) -> Any:
    stamp = divmod(round(1e9 * time), 10**9)
    return make(
        "std_msgs/Header", make("builtin_interfaces/Time", *stamp), frame
    )


def seconds(stamp: Any) -> float:
    return float(stamp.sec + 1e-9 * stamp.nanosec)


def vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
    return make("geometry_msgs/Vector3", x, y, z)


def twist(forward: float, turn: float) -> Any:
    return make("geometry_msgs/Twist", vector(forward), vector(0, 0, turn))


class Node:
    """Participant of the domain of these tests, on this machine only."""

    def __init__(self) -> None:
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("CYCLONEDDS_URI", LOCALHOST)
            self.participant = DomainParticipant(DOMAIN)
        self._ends: list[Any] = []

    def writer(self, topic: str, name: str) -> Any:
        """Offer a topic."""
        return DataWriter(self.participant, self._topic(topic, name), RELIABLE)

    def reader(self, topic: str, name: str) -> Any:
        """Take a topic."""
        return DataReader(self.participant, self._topic(topic, name), RELIABLE)

    def _topic(self, topic: str, name: str) -> Any:
        package, _, short = name.partition("/")
        message = kind(f"{package}/msg/{short}")
        return Topic(self.participant, f"rt{topic}", message)


class Ros2Robot:
    """Unicycle that walks at its last command, in a thread of its own.

    The opponent stays at one place of the robot's frame, as one that moves
    with it.
    """

    def __init__(self, namespace: str, opponent: tuple[float, float]) -> None:
        self.node = Node()
        self._commands = self.node.reader(
            f"{namespace}/cmd_vel", "geometry_msgs/Twist"
        )
        self._odometry = self.node.writer(
            f"{namespace}/odom", "nav_msgs/Odometry"
        )
        self._other = self.node.writer(
            f"{namespace}/other", "geometry_msgs/PointStamped"
        )
        self._opponent = opponent
        self.pose = (0.0, 0.0, 0.0)
        self.velocity = (0.0, 0.0)
        self.obeyed = [self.velocity]  # all that were commanded
        self.frozen = False  # its sensors
        self.stays = False  # its odometry, whose stamps go on
        self.sight_age = 0.0  # [s]
        self.told: list[tuple[float, float, float]] = []  # its poses
        self._ends = Event()
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def moves(self) -> bool:
        """Whether it walks."""
        return any(self.velocity)

    def _run(self) -> None:
        last = sent = monotonic()
        stamp, pose = last, self.pose
        while not self._ends.wait(0.5 * PERIOD):
            for message in self._commands.take(10):
                if isinstance(message, kind("geometry_msgs/msg/Twist")):
                    self.velocity = (message.linear.x, message.angular.z)
                    self.obeyed.append(self.velocity)
            now = monotonic()
            self._move(now - last)
            last = now
            if now - sent < PERIOD:
                continue
            sent = now
            if not self.frozen:
                stamp, pose = now, pose if self.stays else self.pose
            self._tell(stamp, pose)

    def _move(self, passed: float) -> None:
        x, y, heading = self.pose
        forward, turn = self.velocity
        self.pose = (
            x + passed * forward * cos(heading),
            y + passed * forward * sin(heading),
            heading + passed * turn,
        )

    def _tell(self, stamp: float, pose: tuple[float, float, float]) -> None:
        self.told.append(pose)
        x, y, heading = pose
        own = header(stamp, "odom")
        point = make("geometry_msgs/Point", x, y, 0.0)
        half = 0.5 * heading
        turn = make("geometry_msgs/Quaternion", 0.0, 0.0, sin(half), cos(half))
        place = make("geometry_msgs/Pose", point, turn)
        unknown = [0.0] * 36
        self._odometry.write(
            make(
                "nav_msgs/Odometry",
                own,
                "base_link",
                make("geometry_msgs/PoseWithCovariance", place, unknown),
                make(
                    "geometry_msgs/TwistWithCovariance",
                    twist(0.0, 0.0),
                    unknown,
                ),
            )
        )
        other = make("geometry_msgs/Point", *self._opponent, 0.0)
        seen = header(stamp - self.sight_age, "base_link")
        self._other.write(make("geometry_msgs/PointStamped", seen, other))

    def close(self) -> None:
        """Leave the domain."""
        self._ends.set()
        self._thread.join()
        del self._commands, self._odometry, self._other
