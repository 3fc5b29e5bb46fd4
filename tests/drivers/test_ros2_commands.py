"""Test that commands have the type that subscribers take."""

import os
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("cyclonedds")

from stepaside.core.poses import Pose  # noqa: E402
from stepaside.drivers.ros2.dds_domain import DdsParticipant, take_messages  # noqa: E402
from stepaside.drivers.ros2.messages import (  # noqa: E402
    Header,
    Odometry,
    PointStamped,
    PoseWithCovariance,
    Time,
    Twist,
    TwistStamped,
    TwistWithCovariance,
    Vector3,
)
from stepaside.drivers.ros2.ros2_body import Ros2Body, command_standstill  # noqa: E402
from stepaside.drivers.ros2.ros2_server import Ros2Server, WorldClock  # noqa: E402
from stepaside.drivers.ros2.topics import (  # noqa: E402
    dds_topic,
    pose_message,
    vector,
)
from stepaside.drivers.velocity.template_controller import TemplateController  # noqa: E402
from stepaside.drivers.velocity.velocity_body import (  # noqa: E402
    REST,
    VelocityCommand,
    VelocityReport,
)
from stepaside.drivers.velocity.velocity_limits import VelocityLimits  # noqa: E402
from stepaside.drivers.velocity.velocity_loop import DrivingState, VelocityLoop
from stepaside.drivers.velocity.watchdog import WatchSettings  # noqa: E402
from stepaside.planning import GaitSettings  # noqa: E402
from stepaside.strategies import Pursuit  # noqa: E402

from velocity_fakes import SimulatedUnicycle, until  # isort: skip  # noqa: E402

TAG = f"stepaside-commands-{os.getpid()}"
TOPIC = dds_topic("/nao", "cmd_vel")
ZERO = (0.0,) * 36
ASKED = VelocityCommand(0.05, -0.2, 0.03)


class Robot:
    """A robot of others: it tells its odometry, and takes some type."""

    def __init__(self, *kinds: type[Any]) -> None:
        self.dds = DdsParticipant(0, tag=TAG)
        self.odometry = self.dds.writer(dds_topic("/nao", "odom"), Odometry)
        self.sight = self.dds.writer(dds_topic("/nao", "other"), PointStamped)
        self.readers = {kind: self.subscribe(kind) for kind in kinds}
        self.time = 50.0

    def subscribe(self, kind: type[Any]) -> Any:
        """Take commands of a type."""
        return self.dds.reader(TOPIC, kind)

    def tell(self) -> None:
        """Publish its pose and a sighting straight ahead."""
        self.time += 0.05
        header = Header(Time.of(self.time), "nao/odom")
        own = Header(header.stamp, "nao/base_link")
        self.sight.write(PointStamped(own, Vector3(2.0, 0.5, 0.0)))
        self.odometry.write(
            Odometry(
                header,
                "nao/base_link",
                PoseWithCovariance(pose_message(Pose(0.0, 0.0, 0.0)), ZERO),
                TwistWithCovariance(Twist(vector(), vector()), ZERO),
            )
        )

    def close(self) -> None:
        """Leave."""
        self.dds.close()


@pytest.fixture
def body() -> Iterator[Ros2Body]:
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nao")
    yield body
    body.close()


def heard(robot: Robot, body: Ros2Body) -> VelocityReport:
    """The next report of a robot."""

    def report() -> VelocityReport | None:
        robot.tell()
        return body.listen(0.005)

    found: VelocityReport = until(report)
    return found


def taken_by(robot: Robot, body: Ros2Body, kind: type[Any]) -> Any:
    """The newest message that a robot takes."""

    def message() -> Any:
        heard(robot, body)
        body.command(ASKED)
        found = take_messages(robot.readers[kind])
        return found and found[-1]

    return until(message)


@pytest.mark.parametrize("kind", [Twist, TwistStamped])
def test_a_robot_is_commanded_in_the_type_that_it_takes(
    kind: type[Any], body: Ros2Body
) -> None:
    robot = Robot(kind)
    message = taken_by(robot, body, kind)
    twist = message if kind is Twist else message.twist
    linear = twist.linear
    assert (linear.x, twist.angular.z, linear.y) == ASKED
    publishers = robot.readers[kind].get_matched_publications()
    assert len(publishers) == 1
    robot.close()


def test_a_stamp_is_of_the_robots_clock_and_frame(body: Ros2Body) -> None:
    """Robots reject commands whose stamp is old by their clock."""
    robot = Robot(TwistStamped)
    header = taken_by(robot, body, TwistStamped).header
    assert header.frame_id == "nao/base_link"
    assert robot.time - 1.0 < header.stamp.seconds <= robot.time
    robot.close()


def test_a_subscriber_of_both_types_receives_both(body: Ros2Body) -> None:
    """Two subscribers of different types both receive commands."""
    robot = Robot(Twist, TwistStamped)
    stamped = taken_by(robot, body, TwistStamped)
    assert stamped.twist == taken_by(robot, body, Twist)
    robot.close()


def test_a_type_that_is_taken_later_is_written_from_then_on(
    body: Ros2Body,
) -> None:
    robot = Robot(Twist)
    taken_by(robot, body, Twist)
    del robot.readers[Twist]
    robot.readers[TwistStamped] = robot.subscribe(TwistStamped)
    assert taken_by(robot, body, TwistStamped).twist.linear.x == 0.05
    robot.close()


def test_without_a_subscriber_nothing_walks_and_the_reason_is_said(
    body: Ros2Body,
) -> None:
    robot = Robot()
    playing = VelocityLoop(
        body,
        lambda: TemplateController(Pursuit(), GaitSettings()),
        VelocityLimits(),
        WatchSettings(silence=60.0, lead=10.0),
    )

    def tick() -> Any:
        robot.tell()
        return playing.tick()

    why = "nothing subscribes to /nao/cmd_vel"
    waits = until(lambda: (t := tick()).reason == why and t)
    assert waits.state is DrivingState.WAITING and waits.velocity == REST
    for _ in range(20):
        assert tick().state is DrivingState.WAITING
    robot.readers[TwistStamped] = robot.subscribe(TwistStamped)
    until(lambda: tick().state is DrivingState.WALKING)
    del robot.readers[TwistStamped]
    until(lambda: (t := tick()).reason == why and t.velocity == REST)
    robot.close()


def test_a_subscriber_of_something_else_is_named(body: Ros2Body) -> None:
    robot = Robot(Vector3)
    said = until(lambda: heard(robot, body).hindrance.startswith("/") and 1)
    assert said
    assert heard(robot, body).hindrance == (
        "/nao/cmd_vel is subscribed as geometry_msgs/Vector3, not as "
        "geometry_msgs/Twist or geometry_msgs/TwistStamped"
    )
    robot.close()


def test_another_publisher_of_either_type_hinders(body: Ros2Body) -> None:
    robot, other = Robot(Twist), DdsParticipant(0, tag=TAG)
    until(lambda: not heard(robot, body).hindrance)
    writer = other.writer(TOPIC, TwistStamped)
    said = "1 others command this robot"
    until(lambda: heard(robot, body).hindrance == said)
    del writer
    until(lambda: not heard(robot, body).hindrance)
    other.close()
    robot.close()


def test_one_that_only_reads_and_thinks_offers_no_commands() -> None:
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nao", dry_run=True)
    robot = Robot(Twist, TwistStamped)
    for _ in range(20):
        assert heard(robot, body).hindrance == ""
        body.command(ASKED)
    for reader in robot.readers.values():
        assert not reader.get_matched_publications()
    body.close()
    robot.close()


def test_rest_in_place_of_control_is_written_as_it_is_taken() -> None:
    robot = Robot(TwistStamped)
    command_standstill(DdsParticipant(0, tag=TAG), "/nao", 0.5)
    found = take_messages(robot.readers[TwistStamped])
    assert found and all(m.twist.linear.x == 0.0 for m in found)
    robot.close()


@pytest.mark.parametrize("kind", [Twist, TwistStamped])
def test_a_served_robot_follows_either_type(
    kind: type[Any], caplog: pytest.LogCaptureFixture
) -> None:
    """It says that it does not step sideways."""
    dds, other = DdsParticipant(0, tag=TAG), DdsParticipant(0, tag=TAG)
    walker = SimulatedUnicycle()
    clock = WorldClock(dds)
    server = Ros2Server(dds, "/nao", walker, ["a"], clock, tick=0.012)
    writers = [other.writer(TOPIC, kind)]
    twist = Twist(Vector3(0.05, -0.02), Vector3(0.0, 0.0, 0.1))
    header = Header(Time.of(3.0), "base_link")
    message = twist if kind is Twist else TwistStamped(header, twist)

    def obeys() -> bool:
        writers[0].write(message)
        server.speak()
        server.act()
        return walker.commanded == VelocityCommand(0.05, 0.1)

    until(obeys)
    assert server.connected and not server.refused
    assert caplog.text.count("linear.y is ignored") == 1
    writers.clear()

    def left() -> bool:
        server.speak()
        server.act()
        return not server.connected and walker.commanded == REST

    until(left)
    server.close()
    other.close()
    dds.close()


def test_a_served_robot_goes_from_one_type_to_the_other() -> None:
    """One type at a time: the second commander waits for the first."""
    dds, other = DdsParticipant(0, tag=TAG), DdsParticipant(0, tag=TAG)
    walker = SimulatedUnicycle()
    server = Ros2Server(
        dds, "/nao", walker, ["a"], WorldClock(dds), tick=0.012
    )
    writers = [other.writer(TOPIC, Twist)]

    def asked(message: Any, forward: float) -> bool:
        writers[-1].write(message)
        server.speak()
        server.act()
        return walker.commanded.forward == forward

    first = Twist(Vector3(0.01), Vector3())
    until(lambda: asked(first, 0.01))
    writers.append(other.writer(TOPIC, TwistStamped))
    second = TwistStamped(
        Header(Time.of(0.0), ""), Twist(Vector3(0.02), Vector3())
    )
    for _ in range(20):
        assert not asked(second, 0.02)
    del writers[0]
    until(lambda: asked(second, 0.02))
    other.close()
    server.close()
    dds.close()


def test_a_robot_that_is_not_found_is_explained_once(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("stepaside.drivers.ros2.ros2_body.HINT_AFTER", 0.05)
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nobody")
    try:
        for _ in range(10):
            assert body.listen(0.02) is None
    finally:
        body.close()
    [message] = [r.getMessage() for r in caplog.records]
    assert message.startswith("nothing publishes /nobody/odom; searched")
    assert "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST" in message
    assert "--network" in message
