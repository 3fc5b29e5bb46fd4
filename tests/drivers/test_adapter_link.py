"""Test the link to a user's joint-driven robot: frames, faults, release."""

import logging
import re
from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from math import degrees, inf, nan
from threading import Event
from time import monotonic, sleep
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.joint.adapter_link import (
    OLDEST,
    AdapterLink,
    connect_releaser,
    own_gains,
)
from stepaside.drivers.joint.frame_receiver import FrameReceiver
from stepaside.drivers.joint.frames import (
    FrameError,
    JointCommand,
    MotorGains,
)
from stepaside.drivers.joint.joint_map import MotorTable
from stepaside.drivers.joint.joint_robot import (
    JointReport,
    JointRobot,
    JointTarget,
    check_joint_robot,
)
from stepaside.drivers.joint.safety_state_machine import RobotState
from stepaside.perception.measurement import Sighting

TICK, SLACK = 0.02, 1.0  # [s]
NAMES = ("hip", "knee")
MOTORS = MotorTable(
    NAMES,
    low=np.array([-1.0, 0.0]),
    high=np.array([1.0, 2.0]),
    speed=np.array([5.0, 5.0]),
    stall_current=np.full(2, inf),
    legs=np.array([0, 1]),
    crouch={},
    tick=TICK,
)
OWN = MotorGains(np.array([100.0, 80.0]), np.array([3.0, 2.0]))


def report(time: float = 0.0, **changes: Any) -> JointReport:
    """A robot that stands."""
    return JointReport(
        time,
        {"hip": 0.1, "knee": 0.2, "head": 9.0},
        {"hip": 0.0, "knee": 0.0},
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 9.8),
        (0.0, 0.0),
        sighting=Sighting(time, 0.3, 2.0),
    )._replace(**changes)


class ScriptedJoints(JointRobot):
    """Robot whose methods do what a test wants."""

    tick = TICK

    def __init__(self) -> None:
        self.calls: list[Any] = []
        self.now = 0.0
        self.hears: Callable[[], Any] = self.next_report
        self.obeys: Callable[[], None] = lambda: None

    def next_report(self) -> JointReport:
        """The report of the next tick."""
        self.now += TICK
        return report(self.now)

    def open(self) -> None:
        """Note the call."""
        self.calls.append("open")

    def listen(self) -> Any:
        """Do what the test wants."""
        return self.hears()

    def command(self, targets: Mapping[str, JointTarget]) -> None:
        """Note the targets."""
        self.calls.append(targets)
        self.obeys()

    def release(self) -> None:
        """Note the call."""
        self.calls.append("release")

    def close(self) -> None:
        """Note the call."""
        self.calls.append("close")


@pytest.fixture
def robot() -> ScriptedJoints:
    return ScriptedJoints()


@pytest.fixture
def link(robot: ScriptedJoints) -> Iterator[AdapterLink]:
    link = AdapterLink(robot, MOTORS, OWN)
    yield link
    link.close()


def frame_of(link: AdapterLink, robot: ScriptedJoints, got: Any) -> Any:
    """The frame of one report."""
    robot.hears = lambda: got
    assert link.wait(SLACK)
    return link.read(link.receive()[-1])


def command(share: float, state: RobotState) -> JointCommand:
    """Command at a share of the stiffness."""
    angles, stiffness = np.array([0.5, 1.5]), np.full(2, share)
    return JointCommand(angles, stiffness, state, False, 1.0)


def until(done: Callable[[], bool]) -> None:
    """Wait for another thread."""
    deadline = monotonic() + SLACK
    while not done():
        assert monotonic() < deadline
        sleep(0.002)


def test_a_report_becomes_a_frame(
    link: AdapterLink, robot: ScriptedJoints
) -> None:
    frame = frame_of(link, robot, report(5.0, foot_forces=[10.0] * 8))
    assert frame.position.tolist() == [0.1, 0.2]
    assert frame.load == pytest.approx(80.0 / 9.81, rel=1e-3)
    seen = link.newest(7, 4)
    assert seen is not None
    assert seen.time == pytest.approx(3 * TICK) and seen.bearing == 0.3
    assert not frame.hindrance


def test_the_robot_must_not_walk_without_a_recent_sighting(
    link: AdapterLink, robot: ScriptedJoints
) -> None:
    old = Sighting(5.0 - OLDEST - 0.01, 0.3, 2.0)
    frame = frame_of(link, robot, report(5.0, sighting=old))
    assert frame.hindrance == "no sighting of the opponent"
    assert link.newest(0, 0) is None


def test_reports_are_numbered_by_their_times(
    link: AdapterLink, robot: ScriptedJoints
) -> None:
    """A faster source gives one frame per tick, a gap is counted."""
    times = iter([5.0, 5.004, 5.009, 5.021, 5.062, 5.062])
    robot.hears = lambda: report(next(times))
    numbers = []
    for _ in range(3):
        link.wait(SLACK)
        numbers += [link.read(data).number for data in link.receive()]
    assert numbers == [0.0, 1.0, 3.0]


def test_commands_carry_gains_and_are_released_when_limp(
    link: AdapterLink, robot: ScriptedJoints
) -> None:
    link.send(link.write(command(0.5, RobotState.REACHING)))
    until(lambda: len(robot.calls) == 2)
    assert robot.calls[-1]["knee"] == JointTarget(1.5, 40.0, 1.0)
    link.send(link.write(command(0.0, RobotState.LIMP)))
    until(lambda: robot.calls[-1] == "release")
    link.send(link.write(command(0.0, RobotState.LIMP)))
    link.close()
    assert robot.calls.count("release") == 1 and robot.calls[-1] == "close"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"positions": {"hip": 0.0, "knee": nan}}, "positions must be finite"),
        (
            {"positions": {"hip": degrees(0.5), "knee": 0.0}},
            r"hip is at 28.65 rad, outside its range .*degrees",
        ),
        ({"gyro": (0.0, 0.0, degrees(1.0))}, r"gyro .*deg/s"),
        ({"tilt": (0.0, degrees(0.1))}, "tilt .*degrees"),
        ({"accelerometer": (0.0, nan, 9.8)}, "accelerometer must be finite"),
        ({"sighting": Sighting(0.0, 28.0, 2.0)}, "bearing of the sighting"),
    ],
)
def test_implausible_values_are_refused_with_the_method(
    changes: dict[str, Any],
    said: str,
    link: AdapterLink,
    robot: ScriptedJoints,
) -> None:
    with pytest.raises(FrameError, match=said) as caught:
        frame_of(link, robot, report(**changes))
    assert str(caught.value).startswith("listen() of ScriptedJoints: ")


@pytest.mark.parametrize(
    ("got", "said"),
    [
        (42, "must return a JointReport"),
        (report(positions={"hip": 0.1}), "positions lack knee"),
        (report(gyro=(0.0, 0.0)), "must return a JointReport"),
        (report(time=nan), "time must be finite"),
    ],
)
def test_what_is_no_report_ends_the_session(
    got: Any, said: str, link: AdapterLink, robot: ScriptedJoints
) -> None:
    with pytest.raises(SessionLost, match=rf"listen\(\) of .*{said}"):
        frame_of(link, robot, got)


def test_a_repeated_report_counts_as_silence(
    link: AdapterLink, robot: ScriptedJoints
) -> None:
    same = report(5.0)
    frame_of(link, robot, same)
    with pytest.raises(SessionLost, match=r"listen\(\) .*no new report"):
        link.wait(0.05)


def test_reports_that_stay_implausible_end_the_session_with_the_reason(
    link: AdapterLink, robot: ScriptedJoints
) -> None:
    def hears() -> JointReport:
        sleep(0.002)
        return robot.next_report()._replace(gyro=(nan, 0.0, 0.0))

    robot.hears = hears
    silent_for = 9.9  # of a patience of 10 s
    times = chain([monotonic() - silent_for], iter(monotonic, None))
    receiver = FrameReceiver(link, 0.1, times.__next__, link.read, TICK)
    with pytest.raises(SessionLost, match=r"refused: listen\(\) .*gyro must"):
        receiver.listen()


@pytest.mark.parametrize("method", ["listen", "command"])
def test_a_method_that_does_not_return_loses_the_session(
    method: str, link: AdapterLink, robot: ScriptedJoints
) -> None:
    """The robot is released beside it."""
    blocked = Event()
    link.send(link.write(command(1.0, RobotState.WALKING)))
    until(lambda: len(robot.calls) == 2)
    waits: Callable[[], Any] = blocked.wait
    if method == "listen":
        robot.hears = waits
        with pytest.raises(SessionLost, match=r"listen\(\) .*not returned"):
            link.wait(0.05)
    else:
        robot.obeys = waits
        link.send(link.write(command(1.0, RobotState.WALKING)))
        sleep(0.3)
        with pytest.raises(SessionLost, match=r"command\(\) .*not returned"):
            link.send(link.write(command(1.0, RobotState.WALKING)))
    sleep(0.3)
    began = monotonic()
    link.close()
    assert robot.calls[-1] == "release"
    assert monotonic() - began < SLACK
    blocked.set()


@pytest.mark.parametrize("method", ["listen", "command"])
def test_a_method_that_raises_loses_the_session(
    method: str, link: AdapterLink, robot: ScriptedJoints
) -> None:
    def fails() -> None:
        raise OSError("cable out")

    said = rf"{method}\(\) of ScriptedJoints failed: OSError: cable out"
    if method == "listen":
        robot.hears = fails
        with pytest.raises(SessionLost, match=said):
            link.wait(SLACK)
    else:
        robot.obeys = fails
        link.send(link.write(command(1.0, RobotState.WALKING)))
        until(lambda: len(robot.calls) == 2)
        sleep(0.02)
        with pytest.raises(SessionLost, match=said):
            link.send(link.write(command(1.0, RobotState.WALKING)))


def test_walking_begins_without_a_button(
    link: AdapterLink, robot: ScriptedJoints
) -> None:
    pressed = []
    for state in (RobotState.REACHING, RobotState.READY, RobotState.READY):
        link.write(command(1.0, state))
        robot.hears = robot.next_report
        link.wait(SLACK)
        pressed.append(link.read(link.receive()[-1]).chest_pressed)
    assert pressed == [False, True, False]


def test_the_papers_walk_needs_foot_forces(robot: ScriptedJoints) -> None:
    link = AdapterLink(robot, MOTORS, OWN, needs_forces=True)
    with pytest.raises(FrameError, match=r"foot_forces are needed .*--legs"):
        frame_of(link, robot, report())
    link.close()


def test_gains_come_from_the_robot_or_its_description(
    robot: ScriptedJoints,
) -> None:
    robot.gains = {"hip": (50.0, 1.0)}
    described = {"hip": (9.0, 9.0), "knee": (30.0, 2.0)}
    gains = own_gains(robot, MOTORS, described)
    assert gains.stiffness.tolist() == [50.0, 30.0]
    with pytest.raises(ConfigurationError, match="gains lack knee"):
        own_gains(robot, MOTORS, {})


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"tick": 5.0}, r"tick must be in \[0.001, 0.1\] s, got 5.0"),
        ({"paced": 1}, "paced must be True or False"),
        ({"gains": {"hip": (1.0,)}}, "gains of hip must be a stiffness"),
        ({"gains": {"hip": (nan, 1.0)}}, "gains of hip"),
    ],
)
def test_an_invalid_class_is_refused(
    changes: dict[str, Any], said: str
) -> None:
    kind = type("Changed", (ScriptedJoints,), changes)
    with pytest.raises(ConfigurationError, match=f"robot r.py:R: {said}"):
        check_joint_robot(kind, "robot r.py:R")


def test_the_guardian_releases_by_its_own_connection() -> None:
    made: list[ScriptedJoints] = []

    def make() -> ScriptedJoints:
        made.append(ScriptedJoints())
        return made[-1]

    release = connect_releaser(make)
    assert made[0].calls == ["open"]
    release()
    assert made[0].calls == ["open", "release"]


def test_a_release_that_fails_is_logged(
    robot: ScriptedJoints, caplog: pytest.LogCaptureFixture
) -> None:
    def fails() -> None:
        raise OSError("cable out")

    link = AdapterLink(robot, MOTORS, OWN)
    link.send(link.write(command(1.0, RobotState.WALKING)))
    until(lambda: len(robot.calls) == 2)
    robot.release = fails  # type: ignore[method-assign]
    with caplog.at_level(logging.WARNING):
        link.close()
    assert re.search(r"release\(\) of .*cable out", caplog.text)
