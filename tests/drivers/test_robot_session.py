"""Test the session with a robot of a class: what it calls, and survives."""

import logging
import os
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from threading import Event
from time import monotonic, sleep
from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.drivers import method_thread, robot_session
from stepaside.drivers.guardian_process import Guardian
from stepaside.drivers.method_thread import BLOCKED, SessionLost
from stepaside.drivers.robot import JointRobot, VelocityLimits, VelocityRobot
from stepaside.drivers.robot_reports import plain_report
from stepaside.drivers.robot_session import RobotSession
from stepaside.perception.measurement import RobotState

LONGEST = 60.0  # for what takes milliseconds, in [s]
WALK = (-0.2, 0.1, 0.4)


class ScriptedRobot(VelocityRobot):
    """Robot whose methods do what a test wants."""

    limits = VelocityLimits(0.5, 0.4, 1.0)

    def __init__(self) -> None:
        self.calls: list[Any] = []
        self.hears: Callable[[], Any] = self.state
        self.obeys: Callable[[], Any] = lambda: None
        self.stops: Callable[[], Any] = lambda: None

    def state(self) -> RobotState:
        """A robot that stands, now."""
        return RobotState(monotonic(), pose=Pose(0.0, 0.0, 0.0))

    def open(self) -> None:
        """Note the call."""
        self.calls.append("open")

    def listen(self) -> RobotState | None:
        """Do what the test wants."""
        got: RobotState | None = self.hears()
        return got

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Do what the test wants."""
        self.obeys()
        self.calls.append((forward, lateral, turn))

    def stop(self) -> None:
        """Do what the test wants."""
        self.stops()
        self.calls.append("stop")

    def close(self) -> None:
        """Note the call."""
        self.calls.append("close")


@pytest.fixture
def stuck() -> Iterator[Event]:
    """Event that blocked methods wait for."""
    event = Event()
    yield event
    event.set()


def until(done: Callable[[], Any]) -> None:
    """Wait for something that is true."""
    end = monotonic() + LONGEST
    while not done():
        assert monotonic() < end
        sleep(0.005)


def driven(
    session: RobotSession, robot: ScriptedRobot, done: Callable[[], Any]
) -> None:
    """Run a control that wants to walk, and halts without a report."""

    def tick() -> Any:
        if session.listen(0.05) is None:
            session.halt()
        else:
            session.command(partial(robot.command, *WALK))
        return done()

    until(tick)


def test_a_session_calls_each_method_in_turn() -> None:
    robot = ScriptedRobot()
    session = RobotSession(robot)
    assert session.listen(1.0) is not None
    session.command(partial(robot.command, *WALK))
    until(lambda: WALK in robot.calls)
    session.halt()
    until(lambda: "stop" in robot.calls)
    session.close()
    assert robot.calls == ["open", WALK, "stop", "stop", "close"]


@pytest.mark.parametrize(("paced", "within"), [(True, 15.0), (False, 60.0)])
def test_each_method_has_its_time(
    paced: bool, within: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    told, run = dict[str, float](), method_thread.MethodThread.run

    def noted(self: Any, method: str, most: float, call: Any = None) -> Any:
        told[method] = most
        return run(self, method, most, call)

    monkeypatch.setattr(method_thread.MethodThread, "run", noted)
    robot = ScriptedRobot()
    robot.paced = paced
    session = RobotSession(robot)
    session.run("prepare", robot_session.PREPARE_TIMEOUT)
    session.close()
    assert told == {"open": within, "prepare": 30.0, "close": 2.0}


def test_a_dry_run_only_listens() -> None:
    robot = ScriptedRobot()
    session = RobotSession(robot, dry_run=True)
    assert session.listen(1.0) is not None
    session.command(partial(robot.command, *WALK))
    session.halt()
    session.close()
    assert robot.calls == ["open", "close"]


@pytest.mark.parametrize(
    "got",
    [
        (0.0, 0.0, 0.0),
        RobotState(0.0, pose=None),  # type: ignore[arg-type]
        RobotState(0.0, sighting=2.0, pose=Pose(0, 0, 0)),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_report_ends_the_session_by_the_name_of_the_method(
    got: Any,
) -> None:
    robot = ScriptedRobot()
    robot.hears = lambda: got
    session = RobotSession(robot)
    with pytest.raises(
        SessionLost, match=r"listen\(\) of .* a RobotState\(time, pose"
    ):
        session.listen(1.0)
    session.close()
    assert robot.calls[-2:] == ["stop", "close"]


class TwoJoints(JointRobot):
    """Robot that is asked for nothing."""

    tick, joints = 0.02, ("hip", "knee")

    def listen(self) -> RobotState | None:
        """Return nothing."""
        return None

    def command(self, targets: Any) -> None:
        """Do nothing."""

    def release(self) -> None:
        """Do nothing."""


@pytest.mark.parametrize(
    "changes",
    [
        {"joint_positions": [0.0]},
        {"joint_velocities": None},
        {"gyro": (0.0, 0.0)},
        {"tilt": None},
        {"foot_forces": [1.0]},
        {"status": 3},
    ],
)
def test_a_report_of_joints_is_complete(changes: dict[str, Any]) -> None:
    angles: Any = [0.1, 0.2]
    gyro: Any = (0, 0, 1)
    force: Any = (0.0, 0.0, 9.8)
    valid = RobotState(1.0, angles, gyro, force)
    valid = valid._replace(joint_velocities=angles, tilt=(0.0, 0.1))
    plain = plain_report(valid, TwoJoints(), "listen()")
    assert plain.gyro.tolist() == [0.0, 0.0, 1.0]
    with pytest.raises(SessionLost, match="arrays of 2 joints"):
        plain_report(valid._replace(**changes), TwoJoints(), "listen()")


def test_a_repeated_report_is_returned_after_the_wait_for_a_new_one() -> None:
    robot = ScriptedRobot()
    robot.hears = lambda: RobotState(7.0, pose=Pose(0.0, 0.0, 0.0))
    session = RobotSession(robot)
    session.listen(1.0)
    began = monotonic()
    again = session.listen(0.3)
    assert again is not None and again.time == 7.0
    assert monotonic() - began > 0.2
    assert "returned no new report for 0.30 s" in session.silence(0.3)
    session.close()


@pytest.mark.parametrize("method", ["listen", "command"])
def test_an_exception_ends_the_session_by_the_name_of_the_method(
    method: str,
) -> None:
    robot = ScriptedRobot()

    def fail() -> None:
        raise KeyError("leg")

    robot.hears = fail if method == "listen" else robot.state
    robot.obeys = fail
    session = RobotSession(robot)
    with pytest.raises(
        SessionLost, match=rf"{method}\(\) of ScriptedRobot failed: KeyError"
    ):
        driven(session, robot, lambda: False)
    session.close()
    assert robot.calls[-2:] == ["stop", "close"]


@pytest.mark.parametrize("method", ["listen", "command"])
def test_a_method_that_blocks_halts_the_robot_beside_it(
    method: str, stuck: Event, caplog: pytest.LogCaptureFixture
) -> None:
    """And the robot walks on when the method returns."""
    robot = ScriptedRobot()
    session = RobotSession(robot)
    driven(session, robot, lambda: WALK in robot.calls)
    before = len(robot.calls)
    if method == "listen":
        robot.hears = lambda: (stuck.wait(), robot.state())[1]
    else:
        robot.obeys = lambda: stuck.wait()
    driven(session, robot, lambda: "stop" in robot.calls[before:])
    assert f"{method}() of ScriptedRobot has not returned" in caplog.text
    with pytest.raises(SessionLost, match="has not returned"):
        session.check_blocked()
    stuck.set()
    stopped = len(robot.calls)
    driven(session, robot, lambda: WALK in robot.calls[stopped + 1 :])
    session.close()


def test_a_method_that_blocks_for_five_seconds_ends_the_session(
    stuck: Event,
) -> None:
    robot, begun, times = ScriptedRobot(), Event(), {"now": 0.0}
    session = RobotSession(robot, clock=lambda: times["now"])
    robot.obeys = lambda: stuck.wait() if begun.set() is None else None  # type: ignore[func-returns-value]
    session.command(partial(robot.command, *WALK))
    assert begun.wait(LONGEST)
    for now in (0.2, 0.3, 4.9):
        times["now"] = now
        session.halt()
    until(lambda: "stop" in robot.calls)
    times["now"] = 5.1
    with pytest.raises(SessionLost, match="has not returned for 5.10 s"):
        session.halt()
    stuck.set()


@pytest.mark.parametrize("returns", [True, False])
def test_a_robot_is_halted_after_a_command_that_returns_late(
    returns: bool, stuck: Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also one that closes at once after it was told to halt."""
    robot, begun = ScriptedRobot(), Event()
    if returns:
        monkeypatch.setattr(robot_session, "BLOCKED", LONGEST)
        monkeypatch.setattr(method_thread, "BLOCKED", LONGEST)

    def obey() -> None:
        begun.set()
        stuck.wait(0.1 if returns else None)

    robot.obeys = obey
    session = RobotSession(robot)
    session.command(partial(robot.command, *WALK))
    assert begun.wait(LONGEST)
    session.halt()
    session.close(halts=False)
    returned = [WALK, "stop", "close"] if returns else ["stop"]
    assert robot.calls == ["open", *returned]


def test_a_robot_that_cannot_be_halted_ends_the_session(stuck: Event) -> None:
    robot = ScriptedRobot()
    session = RobotSession(robot)
    robot.hears = robot.stops = lambda: stuck.wait()
    with pytest.raises(SessionLost, match=r"listen\(\).*neither has stop"):
        driven(session, robot, lambda: False)
    with pytest.raises(SessionLost, match=r"stop\(\) .* did not return"):
        session.close()


def test_the_guardian_halts_a_robot_that_control_cannot_halt(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Also one that was commanded zero; control goes on."""
    guardian = Guardian(lambda: (tmp_path / "rest").touch, 0.5)
    robot = ScriptedRobot()
    session = RobotSession(robot, guardian=guardian)
    session.command(partial(robot.command, *WALK))
    session.halt()
    until(lambda: "stop" in robot.calls)
    assert not (tmp_path / "rest").exists()
    robot.stops = lambda: 1 / 0
    with caplog.at_level(logging.WARNING):
        session.close()
    assert (tmp_path / "rest").exists()
    assert "ZeroDivisionError: division by zero; the guardian" in caplog.text
    with pytest.raises(ChildProcessError):
        os.waitpid(guardian.pid, os.WNOHANG)


class NotedGuardian(Guardian):
    """Guardian that only notes what it is told."""

    def __init__(self) -> None:
        self.told: list[str] = []

    def hold(self) -> None:
        """Note the call."""
        self.told.append("hold")

    def leave(self) -> None:
        """Note the call."""
        self.told.append("leave")

    def dismiss(self) -> None:
        """Note the call."""
        self.told.append("dismiss")


def test_the_guardian_watches_until_a_late_command_has_returned(
    stuck: Event,
) -> None:
    """Else the robot would walk on if control died meanwhile."""
    robot, guardian, begun = ScriptedRobot(), NotedGuardian(), Event()
    session = RobotSession(robot, guardian=guardian)

    def obey() -> None:
        begun.set()
        stuck.wait(LONGEST)

    robot.obeys = obey
    session.command(partial(robot.command, *WALK))
    assert begun.wait(LONGEST)
    session.halt()
    session.halt()
    assert guardian.told == ["hold"] * 3
    stuck.set()
    assert session.listen(LONGEST) is not None  # after the methods before
    assert "stop" in robot.calls
    session.halt()
    session.close()
    *told, left, dismissed = guardian.told
    assert told[:4] == [*["hold"] * 3, "leave"]
    assert set(told[4:]) <= {"hold"}
    assert (left, dismissed) == ("leave", "dismiss")


def test_the_guardian_watches_until_the_last_halt_has_returned() -> None:
    """Also when the robot was told to halt before the session closes."""
    robot, guardian = ScriptedRobot(), NotedGuardian()
    session = RobotSession(robot, guardian=guardian)

    def stop() -> None:
        sleep(1.2 * BLOCKED)
        guardian.told.append("stopped")

    robot.stops = stop
    session.command(partial(robot.command, *WALK))
    until(lambda: WALK in robot.calls)
    session.halt()
    session.close()
    told = guardian.told
    assert "stopped" in told and told.count("hold") > 3
    assert "leave" not in told[: len(told) - 1 - told[::-1].index("stopped")]
    assert told[-2:] == ["leave", "dismiss"]


def test_a_robot_that_does_not_answer_is_tried_again() -> None:
    """Other errors of open() are those of the program."""

    class Absent(ScriptedRobot):
        def open(self) -> None:
            """Fail."""
            raise ConnectionError("no robot")

    class Wrong(ScriptedRobot):
        def open(self) -> None:
            """Fail."""
            raise TypeError("no such argument")

    with pytest.raises(SessionLost, match=r"open\(\) of Absent failed"):
        RobotSession(Absent())
    with pytest.raises(ConfigurationError, match=r"open\(\) of Wrong failed"):
        RobotSession(Wrong())
