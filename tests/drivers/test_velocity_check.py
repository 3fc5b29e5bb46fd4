"""Test that the check of a robot finds each mistake of an adapter."""

import json
from collections.abc import Callable
from math import cos, degrees, nan, sin
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from stepaside.cli.main import main
from stepaside.core.poses import Pose, wrap_angle
from stepaside.drivers.method_check import AdapterFinding
from stepaside.drivers.robot import VelocityRobot
from stepaside.drivers.velocity_check import VelocityCheck
from stepaside.drivers.velocity_limits import VelocityLimits
from stepaside.perception.measurement import RobotState, Sighting

Change = Callable[[RobotState], RobotState | None]


class SimulatedClock:
    """Clock that advances where the check pauses."""

    now = 100.0

    def __call__(self) -> float:
        """Time, in [s]."""
        return self.now

    def pause(self, duration: float) -> None:
        """Wait for a time, in [s]."""
        self.now += duration


class KinematicRobot(VelocityRobot):
    """Robot that moves as commanded, and reports with some mistake."""

    limits = VelocityLimits(0.5, 0.4, 1.0, lateral=0.3)

    def __init__(self) -> None:
        self.change: Change = lambda report: report
        self.velocity = (0.0, 0.0, 0.0)
        self.pose = Pose(0.0, 0.0, 0.0)
        self.clock = SimulatedClock()
        self.time = self.commanded = self.clock()
        self.timeout = float("inf")
        self.turn_sign = 1.0
        self.calls: list[str] = []

    def open(self) -> None:
        """Note the call."""
        self.calls.append("open")

    def prepare(self) -> None:
        """Note the call."""
        self.calls.append("prepare")

    def listen(self) -> RobotState | None:
        """Move on, and report."""
        now = self.clock()
        passed, self.time = now - self.time, now
        if now - self.commanded > self.timeout:
            self.velocity = (0.0, 0.0, 0.0)
        ahead, left, turn = self.velocity
        x, y, theta = self.pose
        self.pose = Pose(
            x + passed * (ahead * cos(theta) - left * sin(theta)),
            y + passed * (ahead * sin(theta) + left * cos(theta)),
            wrap_angle(theta + passed * turn * self.turn_sign),
        )
        return self.change(RobotState(now, pose=self.pose))

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Move as commanded."""
        self.velocity, self.commanded = (forward, lateral, turn), self.clock()

    def stop(self) -> None:
        """Stand."""
        self.calls.append("stop")
        self.velocity = (0.0, 0.0, 0.0)

    def close(self) -> None:
        """Note the call."""
        self.calls.append("close")


class StopsByItself(KinematicRobot):
    """Robot with a timeout of its own, as it says."""

    keeps_walking = False


class IgnoresStop(KinematicRobot):
    """Robot whose stop() does nothing."""

    def stop(self) -> None:
        """Walk on."""


def checked(
    robot: KinematicRobot, *, dry_run: bool = False
) -> dict[str, AdapterFinding]:
    """Check a robot, and return the findings by name."""
    check = VelocityCheck(
        robot,
        lambda finding: None,
        dry_run=dry_run,
        clock=robot.clock,
        pause=robot.clock.pause,
    )
    check.run()
    assert check.passes == all(f.verdict != "fail" for f in check.findings)
    return {finding.name: finding for finding in check.findings}


def failed(found: dict[str, AdapterFinding]) -> dict[str, str]:
    return {n: f.text for n, f in found.items() if f.verdict == "fail"}


def test_a_correct_robot_passes_each_check() -> None:
    robot = KinematicRobot()
    found = checked(robot)
    assert failed(found) == {}
    assert found["turn left"].value == pytest.approx(0.5, abs=0.02)
    assert found["walk ahead"].value == pytest.approx(0.2, abs=0.02)
    assert found["walk back"].value == pytest.approx(-0.2, abs=0.02)
    assert found["walk left"].value == pytest.approx(0.15, abs=0.02)
    assert "turns on" in found["without commands"].text
    assert robot.calls[:2] == ["open", "prepare"]
    assert robot.calls[-2:] == ["stop", "close"]


def test_a_dry_run_only_listens() -> None:
    robot = KinematicRobot()
    found = checked(robot, dry_run=True)
    assert robot.calls == ["open", "close"]
    assert "rate" in found and "turn left" not in found


def in_degrees(report: RobotState) -> RobotState:
    x, y, theta = report.pose
    return report._replace(pose=Pose(x, y, degrees(theta)))


def in_millimetres(report: RobotState) -> RobotState:
    x, y, theta = report.pose
    return report._replace(pose=Pose(1e3 * x, 1e3 * y, theta))


def seen(bearing: float, age: float) -> Change:
    def change(report: RobotState) -> RobotState:
        sighting = Sighting(report.time - age, bearing, 1.0)
        return report._replace(sighting=sighting)

    return change


@pytest.mark.parametrize(
    ("change", "name", "said"),
    [
        (in_degrees, "turn left", "is the heading in degrees"),
        (in_millimetres, "walk ahead", "is the position in millimetres"),
        (
            lambda r: r._replace(time=1e3 * r.time),
            "times",
            "1e+03 times as fast as time",
        ),
        (lambda r: r._replace(time=-r.time), "times", "before the last one"),
        (lambda r: r._replace(time=7.0), "rate", "1 reports with a new time"),
        (lambda r: None, "rate", "0 reports"),
        (
            lambda r: r._replace(pose=Pose(nan, 0.0, 0.0)),
            "pose",
            "must be finite",
        ),
        (
            lambda r: r._replace(pose=Pose(r.time, 0.0, 0.0)),
            "pose",
            "drifts by 1.0",
        ),
        (seen(90.0, 0.0), "sighting", "bearing of the sighting"),
        (seen(0.3, 2.0), "sighting", "2.00 s old at most"),
    ],
)
def test_a_mistake_in_reports_is_found(
    change: Change, name: str, said: str
) -> None:
    robot = KinematicRobot()
    robot.change = change
    found = failed(
        checked(robot, dry_run=name not in ("turn left", "walk ahead"))
    )
    assert said in found[name]


def test_a_turn_to_the_wrong_side_is_found() -> None:
    robot = KinematicRobot()
    robot.turn_sign = -1.0
    assert "the sign is wrong" in failed(checked(robot))["turn left"]


def test_a_robot_that_does_not_stop_is_found() -> None:
    assert "still turns" in failed(checked(IgnoresStop()))["stop"]


def test_whether_the_robot_keeps_walking_is_compared() -> None:
    """The safe way round is only a hint."""
    robot = StopsByItself()
    assert "must be True" in failed(checked(robot))["without commands"]
    cautious = KinematicRobot()
    cautious.timeout = 0.6
    finding = checked(cautious)["without commands"]
    assert finding.verdict == "pass" and "may be False" in finding.text


def test_odometry_that_stands_still_in_the_air_is_no_failure() -> None:
    robot = KinematicRobot()
    robot.change = lambda report: report._replace(pose=Pose(0.0, 0.0, 0.0))
    found = checked(robot)
    for name in ("turn left", "walk ahead", "stop", "without commands"):
        assert found[name].verdict == "unknown"


def test_a_method_that_blocks_fails_by_its_name() -> None:
    robot, stuck = KinematicRobot(), Event()
    robot.change = lambda report: stuck.wait(20.0) or report  # type: ignore[assignment,return-value]
    check = VelocityCheck(robot, lambda finding: None)  # in real time
    try:
        check.run()
    finally:
        stuck.set()
    text = {finding.name: finding.text for finding in check.findings}["listen"]
    assert "listen() of KinematicRobot did not return within 2 s" in text
    assert "stop" in robot.calls


FILE = """
import stepaside as sa

class Robot(sa.VelocityRobot):
    limits = sa.VelocityLimits(forward=0.5, backward=0.4, turn=1.0)

    def listen(self):
        return 3.0

    def command(self, forward, lateral, turn):
        raise AssertionError
"""


def test_the_command_prints_verdicts_and_exits_with_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "robot.py"
    file.write_text(FILE, encoding="utf-8")
    words = ["play", f"{file}:Robot", "--check", "--dry-run"]

    def printed(*options: str) -> Any:
        with pytest.raises(SystemExit) as left:
            main([*words, *options])
        assert left.value.code == 1
        return capsys.readouterr().out

    said = "listen() of Robot must return a RobotState"
    assert f"fail     listen            {said}" in printed()
    found = json.loads(printed("--json"))
    assert found["passes"] is False
    assert [f["verdict"] for f in found["findings"]] == ["pass", "fail"]
