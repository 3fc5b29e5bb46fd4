"""Test that ``play`` stops a ROS 2 robot whose reports cannot be trusted.

One robot of others, in this process, is driven by one ``play`` for all tests;
each makes one thing wrong and puts it right again.
"""

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from math import cos, hypot, nan, pi, sin
from pathlib import Path
from threading import Thread
from time import monotonic, sleep
from typing import Any

import pytest

pytest.importorskip("cyclonedds")


from stepaside.drivers.ros2 import read_people
from stepaside.drivers.ros2_dds import (
    DdsParticipant,
    header,
    make,
    take_messages,
    vector,
)

DOMAIN = 150 + os.getpid() % 80
PERIOD = 0.04  # between messages of the robot, in [s]
LONGEST = 60.0  # for what takes seconds on an idle machine, in [s]
SLACK = 1.0  # of a busy machine, in [s]
ZERO = [0.0] * 36
PLAY = "from stepaside.cli.main import main; main()"
WORDS = (
    "play ros2:/it --role pursuer --set gait.speed=0.3 "
    "--set gait.gain=0.6 "
    "--set max_speed=0.4 --set max_turn=0.8 --dead-man ros2:/hold"
).split()


def quaternion(x: float, y: float, z: float, w: float) -> Any:
    return make("geometry_msgs/Quaternion", x, y, z, w)


def point(x: float, y: float) -> Any:
    return make("geometry_msgs/Point", x, y, 0.0)


def pose(place: Any, rotation: Any) -> Any:
    return make("geometry_msgs/Pose", place, rotation)


AHEAD = quaternion(0.0, 0.0, 0.0, 1.0)


class Robot:
    """A robot of others, with the operator's switch."""

    def __init__(self, domain: int) -> None:
        read_people(())  # defines the messages of vision_msgs
        self.dds = dds = DdsParticipant(domain)
        self._odometry = dds.writer("/it/odom", "nav_msgs/msg/Odometry")
        self._points = dds.writer(
            "/it/other", "geometry_msgs/msg/PointStamped"
        )
        self._poses = dds.writer(
            "/it/other_pose", "geometry_msgs/msg/PoseStamped"
        )
        self._detections = dds.writer(
            "/it/detections", "vision_msgs/msg/Detection3DArray"
        )
        self._commands = dds.reader("/it/cmd_vel", "geometry_msgs/msg/Twist")
        self.operator = DdsParticipant(domain)
        self._switch = self.operator.writer("/hold", "std_msgs/msg/Bool")
        self.is_held: bool | None = True
        self.stamp: Callable[[], float] = monotonic
        self.place, self.rotation = point(0.0, 0.0), AHEAD
        self.opponent: tuple[float, float] | None = (2.0, 0.5)
        self.optical = False
        self.velocity, self.lateral = (0.0, 0.0), 0.0
        self._ended = False
        self._thread = Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        while not self._ended:
            self._tell()
            for twist in take_messages(self._commands):
                self.velocity = twist.linear.x, twist.angular.z
                self.lateral = twist.linear.y
            sleep(PERIOD)

    def _tell(self) -> None:
        now = self.stamp()
        if self.is_held is not None:
            self._switch.write(make("std_msgs/Bool", self.is_held))
        if self.opponent is not None:
            head = header(now, "base_link")
            place = point(*self.opponent)
            self._points.write(make("geometry_msgs/PointStamped", head, place))
        if self.optical:
            head = header(now, "camera_optical_frame")
            message = make("vision_msgs/Detection3DArray", head, [])
            self._detections.write(message)
            self.optical = False
        here = pose(self.place, self.rotation)
        still = make("geometry_msgs/Twist", vector(), vector())
        self._odometry.write(
            make(
                "nav_msgs/Odometry",
                header(now, "odom"),
                "base_link",
                make("geometry_msgs/PoseWithCovariance", here, ZERO),
                make("geometry_msgs/TwistWithCovariance", still, ZERO),
            )
        )

    def turn(self, x: float, y: float) -> None:
        """Show the opponent at a place in odometry only."""
        self.opponent = None
        head, there = header(self.stamp(), "odom"), pose(point(x, y), AHEAD)
        self._poses.write(make("geometry_msgs/PoseStamped", head, there))

    def close(self) -> None:
        """Leave."""
        self._ended = True
        self._thread.join()
        self.dds.close()
        self.operator.close()


class Session:
    """The robot, and a ``play`` that drives it."""

    def __init__(self, *options: str, domain: int = DOMAIN) -> None:
        self.robot = Robot(domain)
        self.lines: list[str] = []
        self.process = subprocess.Popen(
            [sys.executable, "-c", PLAY, *WORDS, *options],
            env=os.environ | {"ROS_DOMAIN_ID": str(domain)},
            stderr=subprocess.PIPE,
            text=True,
        )
        Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self.process.stderr is not None
        self.lines.extend(iter(self.process.stderr.readline, ""))

    def until(self, done: Callable[[], Any]) -> float:
        """Wait, and return how long, in [s]."""
        began = monotonic()
        while not done():
            waited = monotonic() - began
            assert waited < LONGEST and self.process.poll() is None, self.lines
            sleep(0.005)
        return monotonic() - began

    @property
    def walks(self) -> bool:
        """Whether the robot is commanded to walk."""
        return hypot(*self.robot.velocity) > 0.1

    def stops_for(self, cause: str) -> float:
        """Wait until it stands for a cause; return the time to stand."""
        took = self.until(lambda: self.robot.velocity == (0.0, 0.0))
        self.until(lambda: cause in "".join(self.lines))
        for _ in range(10):
            assert self.robot.velocity == (0.0, 0.0)
            sleep(PERIOD)
        return took

    def close(self) -> None:
        """End both."""
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(LONGEST)
        finally:
            self.process.kill()
            self.robot.close()


@pytest.fixture(scope="module")
def running() -> Iterator[Session]:
    session = Session()
    yield session
    session.close()


@pytest.fixture
def session(running: Session) -> Session:
    """The session, walking."""
    robot = running.robot
    robot.stamp, robot.is_held, robot.opponent = monotonic, True, (2.0, 0.5)
    robot.place, robot.rotation = point(0.0, 0.0), AHEAD
    running.until(lambda: running.walks)
    running.lines.clear()
    return running


def test_frozen_odometry_is_none(session: Session) -> None:
    now = monotonic()
    session.robot.stamp = lambda: now
    took = session.stops_for("the stamp stays at")
    assert took < 0.5 + SLACK


def test_odometry_without_a_stamp_is_named(session: Session) -> None:
    session.robot.stamp = lambda: 0.0
    session.stops_for("/it/odom has no stamp: header.stamp is 0")


@pytest.mark.parametrize("part", [0.0, nan])
def test_a_rotation_that_is_none_is_named(
    session: Session, part: float
) -> None:
    session.robot.rotation = quaternion(part, 0.0, 0.0, 0.0)
    session.stops_for("/it/odom has no heading: pose.orientation is zero")


def test_a_pose_that_jumps_stops_the_robot(session: Session) -> None:
    """It goes on from there, with a new controller."""
    commands = [session.robot.velocity]
    session.robot.place = point(50.0, 0.0)

    def jumps() -> bool:
        commands.append(session.robot.velocity)
        return commands[-1] == (0.0, 0.0)

    session.until(jumps)
    session.until(
        lambda: "the position jumped by 50.00 m" in str(session.lines)
    )


def test_a_quaternion_of_any_length_is_its_rotation(session: Session) -> None:
    """Facing left, the robot sees straight ahead what is to the left."""
    robot = session.robot
    for share in range(11):  # a turn, not a jump
        half = 0.25 * pi * share / 10
        robot.rotation = quaternion(0.0, 0.0, 0.4 * sin(half), 0.4 * cos(half))
        sleep(2.0 * PERIOD)
    robot.rotation = quaternion(0.0, 0.0, 0.3, 0.3)

    def goes_straight() -> bool:
        robot.turn(0.0, 2.0)
        forward, turn = robot.velocity
        return forward > 0.1 and abs(turn) < 0.02

    session.until(goes_straight)
    for _ in range(20):
        assert goes_straight()
        sleep(PERIOD)
    for share in range(10, -1, -1):
        half = 0.25 * pi * share / 10
        robot.rotation = quaternion(0.0, 0.0, sin(half), cos(half))
        sleep(2.0 * PERIOD)


def test_a_detection_in_an_optical_frame_hinders_only_for_a_while(
    session: Session,
) -> None:
    session.robot.optical = True
    session.stops_for("detections are in camera_optical_frame")
    took = session.until(lambda: session.walks)
    assert took < 1.0 + SLACK


def test_a_released_switch_stops_the_robot_at_once(session: Session) -> None:
    session.robot.is_held = False
    took = session.stops_for("/hold is not true")
    assert took < 0.3  # 0.5 s without a message


def test_a_switch_that_is_silent_is_released(session: Session) -> None:
    session.robot.is_held = None
    took = session.stops_for("/hold is not true")
    assert took < 0.6 + SLACK


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


def test_a_robot_that_steps_sideways_is_commanded_so(tmp_path: Path) -> None:
    file = tmp_path / "sideways.py"
    file.write_text(SIDEWAYS)
    session = Session(
        *(
            "--set",
            "max_lateral=0.2",
            "--set",
            f"pursuer_strategy={file}:Sideways",
        ),
        domain=DOMAIN + 1,  # the other session goes on
    )
    try:
        # The direction is kept within the limits.
        session.until(lambda: session.robot.lateral == pytest.approx(-0.2))
        assert session.robot.velocity == pytest.approx((0.04, 0.0))
    finally:
        session.close()
