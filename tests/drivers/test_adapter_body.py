"""Test the driver of a user's robot: what it passes on, and survives."""

from collections.abc import Callable, Iterator
from math import degrees
from threading import Event
from time import monotonic, sleep
from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.method_thread import BLOCKED
from stepaside.drivers.velocity.adapter_body import (
    UNSTOPPED,
    AdapterBody,
    connect_adapter_stopper,
)
from stepaside.drivers.velocity.velocity_body import (
    REST,
    VelocityCommand,
    VelocityReport,
)
from stepaside.drivers.velocity.velocity_limits import VelocityLimits
from stepaside.drivers.velocity.velocity_robot import VelocityRobot
from stepaside.perception.measurement import Sighting

WALK = VelocityCommand(-0.2, 0.4, 0.1)
SLACK = 1.0  # of a busy machine, in [s]


class ScriptedRobot(VelocityRobot):
    """Robot whose methods do what a test wants."""

    limits = VelocityLimits(0.5, 0.4, 1.0)

    def __init__(self) -> None:
        self.calls: list[tuple[Any, ...]] = []
        self.hears: Callable[[], Any] = self.state
        self.obeys: Callable[[], None] = lambda: None
        self.stops: Callable[[], None] = lambda: None

    def state(self) -> VelocityReport:
        """A robot that stands, now."""
        return VelocityReport(monotonic(), Pose(0.0, 0.0, 0.0))

    def open(self) -> None:
        """Do what the test wants."""
        self.calls.append(("open",))

    def prepare(self) -> None:
        """Do what the test wants."""
        self.calls.append(("prepare",))

    def listen(self) -> VelocityReport | None:
        """Do what the test wants."""
        got: VelocityReport | None = self.hears()
        return got

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Do what the test wants."""
        self.obeys()
        self.calls.append(("command", forward, lateral, turn))

    def stop(self) -> None:
        """Do what the test wants."""
        self.stops()
        self.calls.append(("stop",))

    def close(self) -> None:
        """Do what the test wants."""
        self.calls.append(("close",))


@pytest.fixture
def stuck() -> Iterator[Event]:
    """Event that blocked methods wait for."""
    event = Event()
    yield event
    event.set()


def until(done: Callable[[], bool]) -> float:
    """Wait, and return how long, in [s]."""
    began = monotonic()
    while not done():
        assert monotonic() - began < 20.0
        sleep(0.005)
    return monotonic() - began


def driven(
    body: AdapterBody, robot: ScriptedRobot, done: Callable[[], bool]
) -> float:
    """Run a control that wants to walk until something is done.

    As the velocity loop does, it commands zero without a report.
    """

    def tick() -> bool:
        report = body.listen(0.05)
        walks = report is not None and not report.hindrance
        body.command(WALK if walks else REST)
        return done()

    return until(tick)


def test_a_session_calls_each_method_in_turn() -> None:
    robot = ScriptedRobot()
    body = AdapterBody(robot)
    assert body.listen(1.0) is not None
    body.command(WALK)
    until(lambda: ("command", -0.2, 0.1, 0.4) in robot.calls)
    body.command(REST)
    body.close()
    assert [call[0] for call in robot.calls] == [
        *("open", "prepare", "command", "stop", "stop", "close")
    ]


def test_a_dry_run_only_listens() -> None:
    robot = ScriptedRobot()
    body = AdapterBody(robot, dry_run=True)
    assert body.listen(1.0) is not None
    body.command(WALK)
    body.close()
    assert robot.calls == [("open",), ("close",)]


def test_reports_are_passed_on_at_50_hz_at_most() -> None:
    body = AdapterBody(ScriptedRobot())
    began, count = monotonic(), 0
    while monotonic() < began + 0.5:
        count += body.listen(0.05) is not None
    body.close()
    assert 2 <= count <= 26


def test_a_person_is_passed_on() -> None:
    robot = ScriptedRobot()
    seen = Sighting.of_position(3.0, 1.0, 1.0)
    robot.hears = lambda: robot.state()._replace(sighting=seen)
    body = AdapterBody(robot)
    report = body.listen(1.0)
    body.close()
    assert report is not None and report.sighting == seen
    assert degrees(seen.bearing) == pytest.approx(45.0)
    assert seen.distance == pytest.approx(2.0**0.5)


@pytest.mark.parametrize(
    ("got", "said"),
    [
        ((0.0, 0.0, 0.0), "must return a VelocityReport"),
        ("pose", "must return a VelocityReport"),
        (VelocityReport(0.0, None), "must return a VelocityReport"),  # type: ignore[arg-type]
        (VelocityReport(0.0, Pose(0, 0, 0), 2.0), "must return"),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_report_ends_the_session_by_the_name_of_the_method(
    got: Any, said: str
) -> None:
    robot = ScriptedRobot()
    robot.hears = lambda: got
    body = AdapterBody(robot)
    with pytest.raises(SessionLost, match=rf"listen\(\) of .*{said}"):
        body.listen(1.0)
    body.close()
    assert ("stop",) in robot.calls


def test_a_repeated_report_is_passed_on_after_the_wait_for_a_new_one() -> None:
    robot = ScriptedRobot()
    robot.hears = lambda: VelocityReport(7.0, Pose(0.0, 0.0, 0.0))
    body = AdapterBody(robot)
    first = body.listen(1.0)
    began = monotonic()
    assert body.listen(0.3) == first
    assert monotonic() - began > 0.2
    body.close()


@pytest.mark.parametrize("method", ["listen", "command"])
def test_an_exception_ends_the_session_by_the_name_of_the_method(
    method: str,
) -> None:
    robot = ScriptedRobot()

    def fail() -> None:
        raise KeyError("leg")

    robot.hears = fail if method == "listen" else robot.state
    robot.obeys = fail
    body = AdapterBody(robot)
    with pytest.raises(
        SessionLost, match=rf"{method}\(\) of ScriptedRobot failed: KeyError"
    ):
        driven(body, robot, lambda: False)
    body.close()
    assert robot.calls[-2:] == [("stop",), ("close",)]


@pytest.mark.parametrize("method", ["listen", "command"])
def test_a_method_that_blocks_stops_the_robot_beside_it(
    method: str, stuck: Event, caplog: pytest.LogCaptureFixture
) -> None:
    """And the robot walks on when the method returns."""
    robot = ScriptedRobot()
    body = AdapterBody(robot)
    driven(body, robot, lambda: bool(robot.calls[2:]))
    before = len(robot.calls)

    def block() -> None:
        if not stuck.wait(20.0):
            raise AssertionError

    if method == "listen":
        robot.hears = lambda: (block(), robot.state())[1]  # type: ignore[func-returns-value]
    else:
        robot.obeys = block
    took = driven(body, robot, lambda: ("stop",) in robot.calls[before:])
    assert took < BLOCKED + SLACK
    assert f"{method}() of ScriptedRobot has not returned" in caplog.text
    stuck.set()
    stopped = len(robot.calls)
    driven(body, robot, lambda: robot.calls[stopped + 2 :][-1:] != [])
    driven(body, robot, lambda: robot.calls[-1][0] == "command")
    body.close()


def test_a_robot_that_cannot_be_stopped_ends_the_session(
    stuck: Event,
) -> None:
    robot = ScriptedRobot()
    body = AdapterBody(robot)
    robot.hears = robot.stops = lambda: stuck.wait(20.0)  # type: ignore[assignment]
    began = monotonic()
    with pytest.raises(SessionLost, match=r"listen\(\).*neither has stop"):
        driven(body, robot, lambda: False)
    assert monotonic() - began < BLOCKED + UNSTOPPED + SLACK
    with pytest.raises(SessionLost, match=r"stop\(\) .* did not return"):
        body.close()


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
        AdapterBody(Absent())
    with pytest.raises(ConfigurationError, match=r"open\(\) of Wrong failed"):
        AdapterBody(Wrong())


def test_the_guardian_connects_in_advance_and_only_stops() -> None:
    made: list[ScriptedRobot] = []

    class Noted(ScriptedRobot):
        def __init__(self) -> None:
            super().__init__()
            made.append(self)

    class StopsByItself(Noted):
        keeps_walking = False

    stop = connect_adapter_stopper(Noted)
    assert made[0].calls == [("open",)]
    stop()
    assert made[0].calls == [("open",), ("stop",)]
    connect_adapter_stopper(StopsByItself)()
    assert made[1].calls == []
