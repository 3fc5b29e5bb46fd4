"""Test a robot on ROS 2 topics: both ends, on the loopback interface."""

import os
import subprocess
import sys
from collections.abc import Iterator
from math import atan2, cos, hypot, nan, pi, sin
from threading import Event, Thread
from time import sleep
from typing import Any

import numpy as np
import pytest

pytest.importorskip("cyclonedds")

from stepaside.core.errors import ConfigurationError  # noqa: E402
from stepaside.core.poses import Pose  # noqa: E402
from stepaside.core.rotations import rotation  # noqa: E402
from stepaside.drivers.ros2 import dds_domain as domain  # noqa: E402
from stepaside.drivers.ros2.dds_domain import DdsParticipant, take_messages  # noqa: E402
from stepaside.drivers.ros2.messages import (  # noqa: E402
    BoundingBox3D,
    ClockMessage,
    Detection3D,
    Detection3DArray,
    Header,
    JointState,
    ObjectHypothesis,
    ObjectHypothesisWithPose,
    Odometry,
    Point,
    PointStamped,
    PoseStamped,
    PoseWithCovariance,
    String,
    TFMessage,
    Time,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from stepaside.drivers.ros2.namespaces import parse_namespace  # noqa: E402
from stepaside.drivers.ros2.odometry_covariance import (  # noqa: E402
    OdometryCovariance,
)
from stepaside.drivers.ros2.ros2_body import (
    Ros2Body,
    command_standstill,
    register_stopper,
)
from stepaside.drivers.ros2.ros2_server import EVERY, Ros2Server, WorldClock
from stepaside.drivers.ros2.topics import (  # noqa: E402
    dds_topic,
    parse_remapping,
    pose_message,
    pose_of,
    rotation_message,
    yaw_rotation,
)
from stepaside.drivers.velocity.velocity_body import REST, VelocityCommand  # noqa: E402
from stepaside.perception.measurement import Sighting  # noqa: E402
from stepaside.report.export.recorded_transforms import rotate  # noqa: E402

from velocity_fakes import SimulatedUnicycle, until  # isort: skip  # noqa: E402

TAG = f"stepaside-test-{os.getpid()}"
TICK = 0.012


class Scene:
    """Served robot and its client."""

    def __init__(self, *, lock_step: bool = False) -> None:
        self.dds = DdsParticipant(0, tag=TAG)
        self.walker = SimulatedUnicycle()
        self.clock = WorldClock(self.dds)
        self.server = Ros2Server(
            self.dds,
            "/nao",
            self.walker,
            ["LKneePitch", "RKneePitch"],
            self.clock,
            tick=TICK,
            lock_step=lock_step,
        )

    def round(self) -> VelocityCommand:
        """One tick of the world."""
        self.server.speak()
        self.server.hear()
        self.server.act()
        velocity = self.walker.commanded
        self.walker.move(velocity, TICK)
        return velocity

    def close(self) -> None:
        """Let go of everything."""
        self.server.close()
        self.dds.close()


@pytest.fixture
def scene() -> Iterator[Scene]:
    scene = Scene()
    yield scene
    scene.close()


@pytest.fixture
def body() -> Iterator[Ros2Body]:
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nao")
    yield body
    body.close()


def met(scene: Scene, body: Ros2Body, velocity: VelocityCommand) -> None:
    """Wait until both ends have found each other."""

    def heard() -> bool:
        body.command(velocity)
        scene.round()
        return body.listen(0.0) is not None and scene.server.connected

    until(heard)
    until(lambda: scene.round() == velocity)


def test_velocities_arrive_and_odometry_comes_back(
    scene: Scene, body: Ros2Body
) -> None:
    met(scene, body, VelocityCommand(-0.07, 0.2))
    scene.walker.pose = Pose(1.0, -2.0, 2.5)
    scene.walker.time = 77.25

    def told() -> Any:
        scene.round()
        report = body.listen(0.002)
        return report if report and report.time >= 77.25 else None

    report = until(told)
    assert hypot(report.pose.x - 1.0, report.pose.y + 2.0) < 0.1
    assert abs(report.pose.theta - 2.5) < 0.3
    assert report.sighting is None and report.hindrance == ""


def test_the_ideal_sight_has_the_robots_sighting(
    scene: Scene, body: Ros2Body
) -> None:
    met(scene, body, REST)
    scene.walker.sighting = Sighting(scene.walker.time, -2.0, 0.75)

    def seen() -> Any:
        scene.round()
        report = body.listen(0.002)
        return report.sighting if report else None

    sighting = until(seen)
    assert sighting.bearing == pytest.approx(-2.0)
    assert sighting.distance == pytest.approx(0.75)
    assert sighting.time == pytest.approx(scene.walker.sighting.time)


@pytest.mark.parametrize("kind", ["point", "pose"])
@pytest.mark.parametrize("frame", ["nao/base_footprint", "nao/odom"])
def test_the_opponent_may_be_given_in_either_frame(
    scene: Scene, body: Ros2Body, kind: str, frame: str
) -> None:
    dds = DdsParticipant(0, tag=TAG)
    scene.walker.pose = own = Pose(1.0, 2.0, 0.5)
    met(scene, body, REST)
    ahead, left = 0.6, -0.3
    place = Point(ahead, left)
    if frame == "nao/odom":
        x, y, _ = own.compose(Pose(ahead, left, 0.0))
        place = Point(x, y)
    header = Header(Time.of(scene.walker.time), frame)
    if kind == "point":
        writer = dds.writer(dds_topic("/nao", "other"), PointStamped)
        message: Any = PointStamped(header, place)
    else:
        writer = dds.writer(dds_topic("/nao", "other_pose"), PoseStamped)
        pose = pose_message(Pose(place.x, place.y, 0.0))
        message = PoseStamped(header, pose)

    def seen() -> Any:
        writer.write(message)
        scene.round()
        report = body.listen(0.002)
        return report.sighting if report else None

    sighting = until(seen)
    assert sighting.bearing == pytest.approx(atan2(left, ahead))
    assert sighting.distance == pytest.approx(hypot(left, ahead))
    dds.close()


def detection(kind: str, x: float, y: float) -> Detection3D:
    """An object of a class, which a second hypothesis doubts."""
    pose = pose_message(Pose(x, y, 0.0))
    nowhere = PoseWithCovariance(pose, [0.0] * 36)
    return Detection3D(
        Header(Time.of(0.0), ""),
        [
            ObjectHypothesisWithPose(ObjectHypothesis(name, score), nowhere)
            for name, score in (("lamp", 0.1), (kind, 0.8))
        ],
        BoundingBox3D(pose, Vector3(0.5, 0.5, 1.7)),
        "",
    )


@pytest.mark.parametrize(
    ("opponent", "frame", "seen"),
    [
        ("", "nao/base_footprint", (0.5, -0.2)),
        ("person", "nao/base_footprint", (1.0, 0.4)),
        ("robot", "nao/base_footprint", None),
        ("person", "camera_optical_frame", None),
    ],
)
def test_the_nearest_detection_of_a_class_is_the_opponent(
    scene: Scene, opponent: str, frame: str, seen: tuple[float, float] | None
) -> None:
    """The topics may have other names."""
    names = {"detections": "/detector/objects"}
    body = Ros2Body(
        DdsParticipant(0, tag=TAG),
        "/nao",
        remapping=names,
        opponent=opponent,
    )
    dds = DdsParticipant(0, tag=TAG)
    writer = dds.writer("rt/detector/objects", Detection3DArray)
    found = [
        detection("person", 3.0, 0.0),
        detection("person", 1.0, 0.4),
        detection("chair", 0.5, -0.2),
    ]
    try:
        met(scene, body, REST)
        until(lambda: writer.get_matched_subscriptions())

        def heard() -> Any:
            header = Header(Time.of(scene.walker.time), frame)
            writer.write(Detection3DArray(header, found))
            scene.round()
            report = body.listen(0.002)
            if report is None or (seen and report.sighting is None):
                return None
            return report

        report = until(heard)
        for _ in range(20):  # the first may come before the detections
            report = heard() or report
        if seen is None:
            assert report.sighting is None
            optical = "optical" in frame
            assert (frame in report.hindrance) is optical
        else:
            assert report.sighting.bearing == pytest.approx(
                atan2(seen[1], seen[0])
            )
            assert report.sighting.distance == pytest.approx(hypot(*seen))
    finally:
        body.close()
        dds.close()


def test_commands_and_odometry_have_the_names_that_are_asked_for() -> None:
    dds = DdsParticipant(0, tag=TAG)
    names = parse_remapping(["odom:=/state/odom", "cmd_vel:=nav/cmd_vel"])
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nao", remapping=names)
    odometry = dds.writer("rt/state/odom", Odometry)
    commands = dds.reader("rt/nav/cmd_vel", Twist)
    pose = PoseWithCovariance(pose_message(Pose(1.0, 0.0, 0.0)), [0.0] * 36)
    still = TwistWithCovariance(Twist(Vector3(), Vector3()), [0.0] * 36)
    header = Header(Time.of(3.0), "odom")
    try:

        def heard() -> Any:
            odometry.write(Odometry(header, "base_footprint", pose, still))
            return body.listen(0.002)

        assert until(heard).pose.x == 1.0

        def obeyed() -> Any:
            body.command(VelocityCommand(0.25, 0.0))
            return take_messages(commands)

        assert until(obeyed)[0].linear.x == 0.25
    finally:
        body.close()
        dds.close()


@pytest.mark.parametrize(
    "rules", [["cmd_vel"], ["speed:=/a"], ["odom:="], 2 * ["odom:=/a"]]
)
def test_an_invalid_remapping_is_refused(rules: list[str]) -> None:
    with pytest.raises(ConfigurationError, match="remap"):
        parse_remapping(rules)


def test_time_frames_and_joints_are_published(scene: Scene) -> None:
    dds = DdsParticipant(0, tag=TAG)
    readers = {
        kind: dds.reader(dds_topic(space, name), kind)
        for space, name, kind in (
            ("", "clock", ClockMessage),
            ("", "tf", TFMessage),
            ("/nao", "joint_states", JointState),
        )
    }
    found: dict[type[Any], Any] = {}

    def told() -> bool:
        scene.round()
        for kind, reader in readers.items():
            for message in take_messages(reader):
                found[kind] = message
        return len(found) == len(readers)

    until(told)
    (transform,) = found[TFMessage].transforms
    assert transform.header.frame_id == "nao/odom"
    assert transform.child_frame_id == "nao/base_footprint"
    assert list(found[JointState].position) == [0.1, 0.2]
    assert list(found[JointState].name) == ["LKneePitch", "RKneePitch"]
    clock = found[ClockMessage].clock.seconds
    assert clock % (EVERY * TICK) == pytest.approx(0.0, abs=1e-9)
    readers.clear()
    dds.close()


def test_a_late_reader_receives_the_description() -> None:
    dds = DdsParticipant(0, tag=TAG)
    server = Ros2Server(
        dds,
        "/nao",
        SimulatedUnicycle(),
        ["LKneePitch", "RKneePitch"],
        WorldClock(dds),
        tick=TICK,
        urdf="<robot/>",
    )
    server.speak()
    late = DdsParticipant(0, tag=TAG)
    topic = dds_topic("/nao", "robot_description")
    readers = [late.reader(topic, String, latched=True)]
    try:
        (message,) = until(lambda: take_messages(readers[0]))
        assert message.data == "<robot/>"
    finally:
        server.close()
        dds.close()
        readers.clear()
        late.close()


@pytest.mark.parametrize("roll", [-0.3, 0.0])
@pytest.mark.parametrize("pitch", [0.2, -1.0])
@pytest.mark.parametrize("heading", [0.0, 3.0])
def test_a_rotation_is_that_of_its_angles(
    roll: float, pitch: float, heading: float
) -> None:
    got = rotation_message(roll, pitch, heading)
    quaternion = np.array([got.w, got.x, got.y, got.z])
    assert np.linalg.norm(quaternion) == pytest.approx(1.0)
    for vector in np.eye(3):
        expected = rotation(roll, pitch, heading) @ vector
        (turned,) = rotate(quaternion[None], vector[None])
        np.testing.assert_allclose(turned, expected, atol=1e-12)


def test_the_covariance_of_odometry_grows_with_the_path() -> None:
    covariance = OdometryCovariance()

    def deviations(pose: Pose) -> Any:
        matrix = np.array(covariance.note(pose)).reshape(6, 6)
        np.linalg.cholesky(matrix)  # it is positive definite
        return np.sqrt(matrix.diagonal()[[0, 1, 5]])

    begin = deviations(Pose(0.0, 0.0, 3.1))
    turned = deviations(Pose(0.0, 0.0, -3.1))  # by 0.08 rad
    assert (begin[:2] == turned[:2]).all() and turned[2] > begin[2]
    assert turned[2] < 0.011
    walked = deviations(Pose(2.0, 0.0, -3.1))
    assert walked[0] == pytest.approx(0.075, abs=0.002)
    assert (deviations(Pose(0.0, 0.0, -3.1)) > walked).all()


def test_a_commander_that_falls_silent_leaves_a_robot_at_rest(
    scene: Scene, body: Ros2Body
) -> None:
    met(scene, body, VelocityCommand(0.05, 0.1))
    moving = [scene.round() for _ in range(60)]
    assert moving[5] == VelocityCommand(0.05, 0.1) and moving[-1] == REST


def test_closing_commands_zero_velocity_first(scene: Scene) -> None:
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nao")
    met(scene, body, VelocityCommand(0.05, 0.1))
    body.close()
    until(lambda: scene.round() == REST)
    until(lambda: scene.round() == REST and not scene.server.connected)


@pytest.mark.parametrize("bad", [nan, float("inf")])
def test_a_velocity_that_is_no_number_is_rest(
    scene: Scene, body: Ros2Body, bad: float
) -> None:
    met(scene, body, VelocityCommand(0.05, 0.1))
    body.command(VelocityCommand(bad, 0.0))
    until(lambda: scene.round() == REST)
    assert scene.server.refused > 0


def test_a_second_commander_is_refused_and_the_first_stops_for_it(
    scene: Scene, body: Ros2Body
) -> None:
    met(scene, body, VelocityCommand(0.05, 0.1))
    dds = DdsParticipant(0, tag=TAG)
    second = dds.writer(dds_topic("/nao", "cmd_vel"), Twist)

    def refused() -> bool:
        second.write(Twist(Vector3(-9.0), Vector3()))
        body.command(VelocityCommand(0.05, 0.1))
        assert scene.round().forward in (0.05, 0.0)
        return scene.server.refused > 0

    until(refused)

    def hindrance() -> str:
        scene.round()
        report = body.listen(0.002)
        return report.hindrance if report else ""

    assert until(hindrance) == "1 others command this robot"
    dds.close()


def test_in_lock_step_each_report_waits_for_its_answer() -> None:
    scene = Scene(lock_step=True)
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nao")
    met(scene, body, VelocityCommand(0.01, 0.0))
    scene.server.press(False)
    scene.server.speak()
    assert not scene.server.hear()
    body.command(VelocityCommand(0.02, 0.0))
    until(scene.server.hear)
    scene.server.act()
    assert scene.walker.commanded == VelocityCommand(0.02, 0.0)
    for _ in range(EVERY - 1):
        scene.server.speak()
        assert scene.server.hear()
    body.close()
    scene.close()


def test_a_report_lost_in_lock_step_is_repeated() -> None:
    """Readers are best-effort: a busy machine may lose a report."""
    scene = Scene(lock_step=True)
    dds = DdsParticipant(0, tag=TAG)
    writer = dds.writer(dds_topic("/nao", "cmd_vel"), Twist)
    reader = dds.reader(dds_topic("/nao", "odom"), Odometry)
    try:
        until(lambda: writer.get_matched_subscriptions())
        until(lambda: reader.get_matched_publications())
        writer.write(Twist(Vector3(), Vector3()))
        until(lambda: (scene.server.hear(), scene.server.connected)[1])
        scene.server.speak()
        first = until(lambda: take_messages(reader))  # without an answer
        again = until(lambda: scene.server.hear() or take_messages(reader))
        assert again[0].header.stamp == first[-1].header.stamp
        writer.write(Twist(Vector3(0.05), Vector3()))
        until(scene.server.hear)
        scene.server.act()
        assert scene.walker.commanded == VelocityCommand(0.05, 0.0)
    finally:
        dds.close()
        scene.close()


def test_in_place_of_control_rest_is_written_for_a_while() -> None:
    dds = DdsParticipant(0, tag=TAG)
    reader = dds.reader(dds_topic("/nao", "cmd_vel"), Twist)
    guardian = Thread(
        target=command_standstill,
        args=(DdsParticipant(0, tag=TAG), "/nao", 1.0),
    )
    guardian.start()
    told = until(lambda: take_messages(reader))[0]
    assert (told.linear.x, told.angular.z) == (0.0, 0.0)
    guardian.join()
    assert len(take_messages(reader)) > 1
    dds.close()


def test_a_guardian_commands_nothing_until_it_acts() -> None:
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nao")
    reader_of = DdsParticipant(0, tag=TAG)
    reader = reader_of.reader(dds_topic("/nao", "cmd_vel"), Twist)
    let_go = register_stopper(DdsParticipant(0, tag=TAG), "/nao")
    sleep(0.5)
    assert body.commanders == 0
    guardian = Thread(target=let_go)
    guardian.start()
    until(lambda: body.commanders == 1)
    told = until(lambda: take_messages(reader))[0]
    assert (told.linear.x, told.angular.z) == (0.0, 0.0)
    guardian.join()
    body.close()
    reader_of.close()


COMMANDER = f"""
import sys
from time import sleep
from stepaside.drivers.ros2.namespaces import parse_namespace  # noqa: E402
from stepaside.drivers.ros2.ros2_body import Ros2Body
from stepaside.drivers.ros2.dds_domain import DdsParticipant
from stepaside.drivers.velocity.velocity_body import VelocityCommand
body = Ros2Body(DdsParticipant(0, tag={TAG!r}), "/nao")
while True:
    body.command(VelocityCommand(0.03, -0.1))
    sleep(0.01)
"""


def test_a_commander_that_is_killed_leaves_a_robot_at_rest(
    scene: Scene,
) -> None:
    """From another process, which has no time to say anything."""
    process = subprocess.Popen([sys.executable, "-c", COMMANDER])
    try:
        until(lambda: scene.round() == VelocityCommand(0.03, -0.1))
        process.kill()
        process.wait(20.0)
        for _ in range(60):
            last = scene.round()
        assert last == REST
    finally:
        process.kill()
        process.wait(20.0)


@pytest.mark.parametrize("heading", [-pi + 1e-6, -1.0, 0.0, 2.0])
def test_poses_survive_their_messages(heading: float) -> None:
    pose = Pose(1.0, -2.0, heading)
    back = pose_of(pose_message(pose))
    assert back == pytest.approx(pose)
    turned = yaw_rotation(heading)
    assert turned.z == pytest.approx(sin(heading / 2.0))
    assert turned.w == pytest.approx(cos(heading / 2.0))


@pytest.mark.parametrize(
    ("text", "namespace"),
    [("ros2:/nao", "/nao"), ("nao", "/nao"), ("ros2:", ""), ("/a/b/", "/a/b")],
)
def test_namespaces_are_read(text: str, namespace: str) -> None:
    assert parse_namespace(text) == namespace


@pytest.mark.parametrize("text", ["ros2:/na o", "/3", "//a", "/a//b", "ä"])
def test_an_invalid_namespace_is_refused(text: str) -> None:
    with pytest.raises(ConfigurationError, match="namespace must be"):
        parse_namespace(text)


def test_a_closed_participant_leaves_while_readers_are_held() -> None:
    """Otherwise later participants would use its configuration."""
    from cyclonedds.core import DDSException

    from stepaside.drivers.ros2.messages import ClockMessage, Time

    dds = DdsParticipant(0, tag=TAG)
    writer = dds.writer("rt/clock", ClockMessage)
    writer.write(ClockMessage(Time.of(1.0)))
    dds.close()
    with pytest.raises(DDSException):
        writer.write(ClockMessage(Time.of(2.0)))


def test_no_two_topics_are_made_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """DDS failed for one of two threads, now and then."""
    entered = [Event(), Event()]
    overlapped = []
    made = iter(entered)

    class Slow:
        def __init__(self, *given: object, **named: object) -> None:
            next(made).set()
            overlapped.append(entered[1].wait(0.05))

    monkeypatch.setattr(domain, "Topic", Slow)
    monkeypatch.setattr(domain, "DataReader", lambda *given, **named: None)
    everybody = [DdsParticipant(0, tag=TAG), DdsParticipant(0, tag=TAG)]
    threads = [
        Thread(target=dds.reader, args=("rt/odom", Odometry))
        for dds in everybody
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for dds in everybody:
        dds.close()
    assert overlapped[0] is False


def test_a_domain_that_has_no_ports_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with pytest.raises(ConfigurationError, match=r"in \[0, 232\], got 233"):
        DdsParticipant(233)
    monkeypatch.setenv("ROS_DOMAIN_ID", "seven")
    with pytest.raises(ConfigurationError, match="ROS_DOMAIN_ID.*'seven'"):
        DdsParticipant()
