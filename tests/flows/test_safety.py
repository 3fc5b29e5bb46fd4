"""What goes wrong on a robot ends in a stop, whose reason is named."""

import os
import pty
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from time import sleep
from typing import Any

import pytest

from flows.calls import play_own, play_ros2
from flows.running import Running, until

OPPONENT = (1.0, 0.4)  # in the robot's frame, in [m]
TEMPLATE: dict[str, Any] = {"speed": 0.2, "gain": 0.5}
FATES = {"killed": signal.SIGKILL, "frozen": signal.SIGSTOP}


@pytest.fixture
def robot() -> Iterator[Any]:
    """Robot that walks on at its last command, on ROS 2 topics."""
    from flows.ros2_peer import Ros2Robot

    made = Ros2Robot("/walker", OPPONENT)
    yield made
    made.close()


def played(start: Callable[..., Running], **more: Any) -> Running:
    from flows.ros2_peer import DOMAIN

    return start(play_ros2("/walker", domain=DOMAIN, **TEMPLATE, **more))


@pytest.mark.parametrize("fate", FATES)
def test_a_walk_stops_when_its_control_is(
    fate: str, robot: Any, start: Callable[..., Running]
) -> None:
    play = played(start)
    until(lambda: robot.moves)
    play.process.send_signal(FATES[fate])
    until(lambda: not robot.moves)
    assert play.end() == -signal.SIGKILL


def test_a_walk_stops_when_the_operator_lets_go(
    robot: Any, start: Callable[..., Running]
) -> None:
    from flows.ros2_peer import make

    hold = robot.node.writer("/hold", "std_msgs/Bool")
    play = played(start, dead_man="/hold")
    play.until_said("dead-man switch: /hold is not true")
    assert not robot.moves

    def held() -> bool:
        hold.write(make("std_msgs/Bool", True))
        sleep(0.02)
        return bool(robot.moves)

    until(held)
    said = play.said.count("dead-man switch")
    until(lambda: hold.write(make("std_msgs/Bool", False)) or not robot.moves)
    until(lambda: play.said.count("dead-man switch") > said)
    until(held)  # and on again
    assert play.interrupt() == 0


def test_a_walk_stops_when_another_commands_the_robot(
    robot: Any, start: Callable[..., Running]
) -> None:
    from flows.ros2_peer import Node

    play = played(start)
    until(lambda: robot.moves)
    assert "command this robot" not in play.said
    other = Node()
    writer = other.writer("/walker/cmd_vel", "geometry_msgs/Twist")
    until(lambda: not robot.moves)
    play.until_said("1 others command this robot")
    del writer
    until(lambda: robot.moves)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("frozen", True, "no odometry for"),  # the last message goes on
        ("stays", True, "the pose does not change while the robot is to"),
        ("pose", (50.0, 0.0, 0.0), "the position jumped by"),
        ("sight_age", 0.7, "the sighting is 0."),
    ],
)
def test_a_walk_stops_when_its_sensors_fail(
    name: str,
    value: Any,
    words: str,
    robot: Any,
    start: Callable[..., Running],
) -> None:
    play = played(start)
    until(lambda: robot.moves)
    before = len(robot.obeyed)
    setattr(robot, name, value)
    until(lambda: (0.0, 0.0) in robot.obeyed[before:])
    play.until_said(words)


JOINT_ROBOT = '''
import os
from time import monotonic, sleep
import stepaside as sa

class Mine(sa.JointRobot):
    """NAO whose joints are where they are told to be."""

    tick = 0.012
    joints = sa.load_tree(sa.load_robot("nao")).joints
    gains = dict.fromkeys(joints, (100.0, 5.0))
    angles = [0.0] * len(joints)

    def listen(self):
        sleep(0.006)
        now = monotonic()
        force = (0.0, 0.0, 9.8 + 0.01 * (now % 0.1))
        return sa.RobotState(
            now, self.angles, (0.0, 0.0, 0.0), force, [6.5] * 8,
            sa.Sighting(now, 0.4, 0.7),
            joint_velocities=[0.0] * len(self.joints), tilt=(0.0, 0.0),
        )

    def command(self, targets):
        self.angles = targets.angles
        self.note("command")

    def release(self):
        self.note("release")

    def note(self, word):
        with open("{log}", "a") as log:
            print(word, os.getpid(), file=log)
'''


@pytest.mark.parametrize("fate", FATES)
def test_joints_are_released_when_their_control_is(
    fate: str, start: Callable[..., Running], tmp_path: Path
) -> None:
    file, log = tmp_path / "mine.py", tmp_path / "log"
    file.write_text(JOINT_ROBOT.format(log=log), encoding="utf-8")
    play = start(play_own(f"{file}:Mine"))

    def calls() -> list[list[str]]:
        lines = log.read_text().splitlines() if log.exists() else []
        return [line.split() for line in lines]

    until(lambda: len(calls()) > 30)
    play.process.send_signal(FATES[fate])
    assert play.end() == -signal.SIGKILL
    word, by = until(lambda: calls()[-1][0] == "release" and calls()[-1])
    assert int(by) != play.process.pid


def test_joints_stop_when_the_operator_lets_go(
    start: Callable[..., Running], tmp_path: Path
) -> None:
    file, log = tmp_path / "mine.py", tmp_path / "log"
    text = JOINT_ROBOT.format(log=log)
    file.write_text(text, encoding="utf-8")
    near, far = pty.openpty()
    play = start(play_own(f"{file}:Mine", dead_man="key", stdin=far))

    def held() -> bool:
        os.write(near, b" ")
        sleep(0.05)
        return "walking" in play.said

    play.until_said("dead-man switch: hold any key to walk")
    assert "walking" not in play.said
    until(held)
    play.until_said("stopping: dead-man switch: hold any key to walk")
    assert play.interrupt() == 0
    last = log.read_text().splitlines()[-1]
    assert last.split() == ["release", str(play.process.pid)]
    os.close(near)
    os.close(far)


def test_a_walk_on_joints_stops_when_its_sensors_freeze(
    start: Callable[..., Running], tmp_path: Path
) -> None:
    """The accelerometer repeats one reading while the legs move."""
    from flows.lola_peer import LolaRobot

    robot = LolaRobot(tmp_path / "e", 0.4, 0.7)
    play = start(play_own(robot.client, duration=60.0))
    until(lambda: robot.moved > 1.0)
    assert "stopping" not in play.said
    robot.faults = {"Accelerometer": [0.0, 0.0, -9.8]}
    play.until_said("stopping: accelerometer reading is constant")
