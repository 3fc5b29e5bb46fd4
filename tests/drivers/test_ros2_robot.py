"""Test a robot on ROS 2 topics: odometry, people, frames and commands."""

import os
from collections.abc import Callable, Iterator
from math import atan2, cos, hypot, nan, pi, sin
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("cyclonedds")

from stepaside.cli.robot_connections import (  # noqa: E402
    open_loop,
    robot_maker,
)
from stepaside.core.errors import ConfigurationError  # noqa: E402
from stepaside.core.poses import Pose  # noqa: E402
from stepaside.drivers.robot_loader import RobotRequest  # noqa: E402
from stepaside.drivers.ros2 import Ros2Robot, make_robot  # noqa: E402
from stepaside.drivers.ros2_dds import (  # noqa: E402
    DdsParticipant,
    header,
    make,
    seconds,
    take_messages,
    vector,
)
from stepaside.games.play_settings import PlaySettings  # noqa: E402
from stepaside.perception.measurement import RobotState  # noqa: E402

from velocity_fakes import until  # isort: skip  # noqa: E402
from stored_values import rows_of

DOMAIN = 20 + os.getpid() % 200
TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
UNKNOWN = [0.0] * 36
VELOCITY = (0.05, -0.02, 0.3)  # ahead, to the left, and turning


def point(x: float, y: float, z: float = 0.0) -> Any:
    return make("geometry_msgs/Point", x, y, z)


def pose(x: float, y: float, heading: float = 0.0) -> Any:
    half = 0.5 * heading
    turn = make("geometry_msgs/Quaternion", 0.0, 0.0, sin(half), cos(half))
    return make("geometry_msgs/Pose", point(x, y), turn)


class Peer:
    """A robot of others: it tells its odometry, and takes commands."""

    def __init__(self, *kinds: str) -> None:
        self.dds = DdsParticipant(DOMAIN)
        self.odometry = self.dds.writer("/it/odom", "nav_msgs/msg/Odometry")
        self.commands = {kind: self.subscribe(kind) for kind in kinds}
        self.time, self.pose = 50.0, Pose(0.0, 0.0, 0.0)
        self.rotation: tuple[float, ...] | None = None  # another quaternion
        self.tells: Callable[[], None] = lambda: None

    def subscribe(self, kind: str) -> Any:
        """Take commands of a type."""
        return self.dds.reader("/it/cmd_vel", kind)

    def tell(self) -> None:
        """Publish what is told, then odometry."""
        self.time += 0.05
        self.tells()
        still = make("geometry_msgs/Twist", vector(), vector())
        here = pose(*self.pose)
        if self.rotation is not None:
            here.orientation = make("geometry_msgs/Quaternion", *self.rotation)
        self.odometry.write(
            make(
                "nav_msgs/Odometry",
                header(self.time, "odom"),
                "base",
                make("geometry_msgs/PoseWithCovariance", here, UNKNOWN),
                make("geometry_msgs/TwistWithCovariance", still, UNKNOWN),
            )
        )  # fmt: skip

    def publish(
        self, topic: str, kind: str, message: Callable[[], Any]
    ) -> Any:
        """Publish a message before each odometry; return the writer."""
        writer = self.dds.writer(topic, kind)
        self.tells = lambda: writer.write(message())
        until(writer.get_matched_subscriptions)
        return writer


@pytest.fixture
def peer() -> Iterator[Peer]:
    made = Peer(TWIST)
    yield made
    made.commands.clear()
    made.dds.close()


def robot_of(*, prepared: bool = True, **more: Any) -> Ros2Robot:
    robot = make_robot(RobotRequest("/it", domain=DOMAIN, **more))()
    robot.open()
    if prepared:
        robot.prepare()
    return robot


@pytest.fixture
def robot() -> Iterator[Ros2Robot]:
    made = robot_of()
    yield made
    made.close()


def heard(peer: Peer, robot: Ros2Robot) -> RobotState:
    """Return the next report."""

    def report() -> RobotState | None:
        peer.tell()
        return robot.listen()

    found: RobotState = until(report)
    return found


def sighted(peer: Peer, robot: Ros2Robot) -> tuple[float, float]:
    """Return bearing and distance of the next sighting."""
    report = until(lambda: (r := heard(peer, robot)).sighting and r)
    return float(report.sighting.bearing), float(report.sighting.distance)


def test_missing_odometry_is_told_once_by_its_name(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("stepaside.drivers.ros2.HINT_AFTER", 0.0)
    robot = make_robot(RobotRequest("/robot_2", domain=DOMAIN))()
    robot.open()
    assert robot.listen() is robot.listen() is None
    robot.close()
    assert caplog.text.count("nothing publishes /robot_2/odom") == 1


def test_odometry_becomes_a_pose(peer: Peer, robot: Ros2Robot) -> None:
    peer.pose = Pose(1.0, -2.0, 2.5)
    report = heard(peer, robot)
    assert report.pose == pytest.approx(peer.pose)
    assert report.time == pytest.approx(peer.time) and report.sighting is None
    peer.rotation = 0.0, 0.0, 0.3, 0.3  # of any length: to the left
    assert heard(peer, robot).pose.theta == pytest.approx(0.5 * pi)


def test_a_message_without_stamp_or_heading_is_named(
    peer: Peer, robot: Ros2Robot
) -> None:
    for part in (0.0, nan):
        peer.rotation = part, 0.0, 0.0, 0.0
        assert heard(peer, robot).hindrance == (
            "/it/odom has no heading: pose.orientation is zero or not finite"
        )
    peer.time = -0.05
    assert heard(peer, robot).hindrance == (
        "/it/odom has no stamp: header.stamp is 0"
    )


SIDEWAYS = """
import stepaside as sa
from stepaside.strategies.velocity_set import BodyVelocity

class Sideways:
    direction, saturated = sa.Direction.FORWARD, False

    def begin(self):
        pass

    def decide(self, knowledge, memory):
        return sa.Intent(velocity=BodyVelocity(0.1, -0.5, 0.0)), None
"""


def test_a_robot_that_steps_sideways_is_commanded_so(
    peer: Peer, tmp_path: Path
) -> None:
    """The direction is kept within the limits, as ``play`` has them."""
    file = tmp_path / "sideways.py"
    file.write_text(SIDEWAYS)
    settings = PlaySettings(
        role="pursuer",
        strategy=f"{file}:Sideways",
        address="ros2:/it",
        sim_time=True,
        max_lateral=0.2,
        max_speed=0.4,
        max_turn=0.8,
        domain=DOMAIN,
    )
    loop = open_loop(settings, robot_maker(settings))
    peer.publish(
        "/it/other",
        "geometry_msgs/msg/PointStamped",
        lambda: make(
            "geometry_msgs/PointStamped",
            *(header(peer.time, "base"), point(1.0, 0.0)),
        ),
    )

    def commanded() -> Any:
        peer.tell()
        loop.tick()
        found = take_messages(peer.commands[TWIST])
        return found and found[-1].linear.y < -0.1999 and found[-1]

    twist = until(commanded)
    loop.close()
    assert twist.linear.y == pytest.approx(-0.2)
    assert (twist.linear.x, twist.angular.z) == pytest.approx((0.04, 0.0))


@pytest.mark.parametrize("frame", ["base", "odom", "map", "camera", ""])
@pytest.mark.parametrize("heading", [0.0, 2.5])
def test_the_opponent_may_be_given_in_any_frame_that_tf_connects(
    peer: Peer, robot: Ros2Robot, frame: str, heading: float
) -> None:
    peer.pose = own = Pose(1.0, 2.0, heading)
    ahead, left = 0.6, -0.3
    offset = Pose(-3.0, 1.0, 0.7)  # of odom in the map
    camera = Pose(0.2, 0.1, -0.4)  # on the robot, 1.5 m high
    x, y = ahead, left
    if frame in ("odom", "map"):
        x, y, _ = own.compose(Pose(x, y, 0.0))
    if frame == "map":
        x, y, _ = offset.compose(Pose(x, y, 0.0))
    if frame == "camera":
        x, y, _ = camera.inverse().compose(Pose(x, y, 0.0))

    def transform(parent: str, child: str, where: Pose, up: float) -> Any:
        turn = pose(0.0, 0.0, where.theta).orientation
        move = make("geometry_msgs/Transform", vector(where.x, where.y, up),
                    turn)  # fmt: skip
        head = header(peer.time, parent)
        return make("geometry_msgs/TransformStamped", head, child, move)

    tf = peer.dds.writer("/tf", "tf2_msgs/msg/TFMessage", 10)
    static = peer.dds.writer(
        "/tf_static", "tf2_msgs/msg/TFMessage", latched=True
    )
    fixed = [transform("base", "camera", camera, 1.5)]
    static.write(make("tf2_msgs/TFMessage", fixed))

    def message() -> Any:
        links = [transform("map", "odom", offset, 0.0)]
        links.append(transform("odom", "base", own, 0.0))
        tf.write(make("tf2_msgs/TFMessage", links))
        where = header(peer.time, frame)
        return make("geometry_msgs/PointStamped", where, point(x, y))

    peer.publish("/it/other", "geometry_msgs/msg/PointStamped", message)
    for _ in range(5):
        sighted(peer, robot)
    bearing, distance = sighted(peer, robot)
    assert bearing == pytest.approx(atan2(left, ahead))
    assert distance == pytest.approx(hypot(left, ahead))


@pytest.mark.parametrize("frame", ["camera_optical_frame", "map"])
def test_a_frame_that_tf_does_not_know_hinders_for_a_while(
    peer: Peer, robot: Ros2Robot, frame: str
) -> None:
    peer.publish(
        "/it/other",
        "geometry_msgs/msg/PointStamped",
        lambda: make(
            "geometry_msgs/PointStamped",
            *(header(peer.time, frame), point(0.0, 0.0, 2.0)),
        ),
    )
    report = until(lambda: (r := heard(peer, robot)).hindrance and r)
    assert report.hindrance == (
        f"other are in {frame}, which tf does not connect with base or odom"
    )
    assert report.sighting is None
    peer.tells = lambda: None
    ended = peer.time + 1.0
    until(lambda: not heard(peer, robot).hindrance)
    assert peer.time < ended


def detection(kind: str, x: float, y: float) -> Any:
    """Return an object of a class, which a second hypothesis doubts."""
    where = make("geometry_msgs/PoseWithCovariance", pose(x, y), UNKNOWN)
    results = [
        make(
            "vision_msgs/ObjectHypothesisWithPose",
            *(make("vision_msgs/ObjectHypothesis", name, score), where),
        )
        for name, score in (("lamp", 0.1), (kind, 0.8))
    ]
    box = make("vision_msgs/BoundingBox3D", pose(x, y), vector(0.5, 0.5, 1.7))
    head = header(0.0, "")
    return make("vision_msgs/Detection3D", head, results, box, "")


@pytest.mark.parametrize(
    ("opponent", "seen"),
    [("", (0.5, -0.2)), ("person", (1.0, 0.4)), ("robot", None)],
)
def test_the_nearest_detection_of_a_class_is_the_opponent(
    peer: Peer, opponent: str, seen: tuple[float, float] | None
) -> None:
    """The topics may have other names."""
    rules = ("detections:=/detector/objects",)
    robot = robot_of(remap=rules, opponent=opponent)
    found = [
        detection("person", 3.0, 0.0),
        detection("person", 1.0, 0.4),
        detection("chair", 0.5, -0.2),
    ]
    peer.publish(
        "/detector/objects",
        "vision_msgs/msg/Detection3DArray",
        lambda: make(
            "vision_msgs/Detection3DArray", header(peer.time, "base"), found
        ),
    )
    if seen is None:
        assert all(heard(peer, robot).sighting is None for _ in range(20))
    else:
        bearing, distance = sighted(peer, robot)
        assert bearing == pytest.approx(atan2(seen[1], seen[0]))
        assert distance == pytest.approx(hypot(*seen))
    robot.close()


def test_people_are_opponents(peer: Peer, robot: Ros2Robot) -> None:
    def person(x: float, y: float) -> Any:
        still = point(0.0, 0.0)
        return make("people_msgs/Person", "", point(x, y), still, 1.0, [], [])

    def people() -> Any:
        found = [person(4.0, 0.0), person(0.0, 1.5)]
        return make("people_msgs/People", header(peer.time, "base"), found)

    peer.publish("/it/people", "people_msgs/msg/People", people)
    assert sighted(peer, robot) == pytest.approx((0.5 * pi, 1.5))


TABLE = """
[[topics]]
name = "/radar"
type = "my_msgs/msg/Blobs"
each = "blobs"
position = "center"

[topics.messages]
"my_msgs/msg/Blob" = "float32 size\\ngeometry_msgs/Point center"
"my_msgs/msg/Blobs" = "std_msgs/Header header\\nmy_msgs/Blob[] blobs"
"""


def test_a_table_of_a_user_adds_topics(peer: Peer, tmp_path: Path) -> None:
    file = tmp_path / "people.toml"
    file.write_text(TABLE)
    robot = robot_of(people=(str(file),))
    blob = make("my_msgs/Blob", 0.5, point(0.0, -1.0))
    peer.publish(
        "/radar",
        "my_msgs/msg/Blobs",
        lambda: make("my_msgs/Blobs", header(peer.time, ""), [blob]),
    )
    assert sighted(peer, robot) == pytest.approx((-0.5 * pi, 1.0))
    robot.close()


@pytest.mark.parametrize(
    ("text", "said"),
    rows_of("test_an_invalid_table_is_refused"),
)  # fmt: skip
def test_an_invalid_table_is_refused(
    text: str, said: str, tmp_path: Path
) -> None:
    file = tmp_path / "people.toml"
    file.write_text(text)
    with pytest.raises(ConfigurationError, match=said):
        make_robot(RobotRequest("/it", people=(str(file),)))


def taken_by(peer: Peer, robot: Ros2Robot, kind: str) -> Any:
    """Return the newest command that a robot takes."""

    def message() -> Any:
        heard(peer, robot)
        robot.command(*VELOCITY)
        found = take_messages(peer.commands[kind])
        return found and found[-1]

    return until(message)


@pytest.mark.parametrize("kind", [TWIST, STAMPED])
def test_a_robot_is_commanded_in_the_type_that_it_takes(
    kind: str, robot: Ros2Robot
) -> None:
    """A stamp is of its own clock and frame: it rejects old ones."""
    peer = Peer(kind)
    message = taken_by(peer, robot, kind)
    twist = message if kind == TWIST else message.twist
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == VELOCITY
    assert len(peer.commands[kind].get_matched_publications()) == 1
    if kind == STAMPED:
        assert message.header.frame_id == "base"
        assert peer.time - 1.0 < seconds(message.header.stamp) <= peer.time
    peer.dds.close()


def test_without_a_subscriber_the_reason_is_said(robot: Ros2Robot) -> None:
    peer = Peer()
    why = "nothing subscribes to /it/cmd_vel"
    until(lambda: heard(peer, robot).hindrance == why)
    peer.commands[STAMPED] = peer.subscribe(STAMPED)
    until(lambda: not heard(peer, robot).hindrance)
    peer.commands[STAMPED] = peer.subscribe("geometry_msgs/msg/Vector3")
    until(lambda: heard(peer, robot).hindrance)
    assert heard(peer, robot).hindrance == (
        "/it/cmd_vel is subscribed as geometry_msgs/Vector3, not as "
        "geometry_msgs/Twist or geometry_msgs/TwistStamped"
    )
    peer.commands.clear()
    peer.dds.close()


def test_another_publisher_of_either_type_hinders(
    peer: Peer, robot: Ros2Robot
) -> None:
    until(lambda: not heard(peer, robot).hindrance)
    other = DdsParticipant(DOMAIN)
    writers = [other.writer("/it/cmd_vel", STAMPED)]
    said = "1 others command this robot"
    until(lambda: heard(peer, robot).hindrance == said)
    writers.clear()
    until(lambda: not heard(peer, robot).hindrance)
    other.close()


def test_one_that_only_reads_offers_no_commands(peer: Peer) -> None:
    robot = robot_of(prepared=False)
    for _ in range(10):
        assert heard(peer, robot).hindrance == ""
    assert not peer.commands[TWIST].get_matched_publications()
    robot.close()


@pytest.mark.parametrize(
    "rules", [["cmd_vel"], ["speed:=/a"], ["odom:="], 2 * ["odom:=/a"]]
)
def test_an_invalid_remapping_is_refused(rules: list[str]) -> None:
    with pytest.raises(ConfigurationError, match="remap"):
        make_robot(RobotRequest("/it", remap=tuple(rules)))


def test_a_domain_that_has_no_ports_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with pytest.raises(ConfigurationError, match=r"in \[0, 232\], got '233'"):
        DdsParticipant(233)
    monkeypatch.setenv("ROS_DOMAIN_ID", "seven")
    with pytest.raises(ConfigurationError, match="ROS_DOMAIN_ID.*'seven'"):
        DdsParticipant()
