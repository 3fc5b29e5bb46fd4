"""Test that the check of a robot finds each mistake of an adapter."""

import json
from collections.abc import Callable, Iterator
from math import cos, degrees, inf, nan, sin
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest

from stepaside.cli.main import main
from stepaside.core.poses import Pose, wrap_angle
from stepaside.drivers import robot_check
from stepaside.drivers.joint_motion import Motors
from stepaside.drivers.robot import (
    JointRobot,
    JointTargets,
    VelocityLimits,
    VelocityRobot,
)
from stepaside.drivers.robot_check import AdapterFinding, RobotCheck
from stepaside.perception.measurement import RobotState, Sighting
from stored_values import compare_stored, content_of

Change = Callable[[RobotState], RobotState | None]


class Clock:
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
        self.clock = Clock()
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


def checked(robot: Any, *, dry_run: bool = False) -> dict[str, AdapterFinding]:
    """Check a robot, and return the findings by name."""
    check = RobotCheck(
        robot,
        MOTORS if isinstance(robot, JointRobot) else None,
        lambda finding: None,
        dry_run=dry_run,
        clock=robot.clock,
        pause=robot.clock.pause,
    )
    check.run()
    assert check.passes == all(f.verdict != "fail" for f in check.findings)
    FOUND.extend(check.findings)
    return {finding.name: finding for finding in check.findings}


FOUND: list[AdapterFinding] = []  # by all checks of a test


@pytest.fixture(autouse=True)
def findings_are_as_stored(request: pytest.FixtureRequest) -> Iterator[None]:
    """Compare all of them, whatever the test looks at."""
    FOUND.clear()
    yield
    compare_stored("plays.json", request.node.name, content_of(FOUND))


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


def stays(report: RobotState) -> RobotState:
    return report._replace(pose=Pose(0.0, 0.0, 0.0))


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


def test_a_method_that_blocks_fails_by_its_name() -> None:
    robot, stuck = KinematicRobot(), Event()
    robot.change = lambda report: stuck.wait(20.0) or report  # type: ignore[assignment,return-value]
    check = RobotCheck(robot, None, lambda finding: None)  # in real time
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


TICK = 0.02
NAMES = ("hip", "knee", "ankle")
MOTORS = Motors(
    NAMES,
    low=np.array([-1.0, 0.0, -0.5]),
    high=np.array([1.0, 2.0, 0.5]),
    speed=np.full(3, 5.0),
    legs=np.arange(3),
    order=np.arange(3),
    stiffness=np.full(3, 100.0),
    damping=np.full(3, 3.0),
)
LAG = 0.06  # from a target to the angle, in [s]


class HangingRobot(JointRobot):
    """Robot in the air that follows its targets with a lag, and swings."""

    tick, joints = TICK, NAMES

    def __init__(self) -> None:
        self.change: Change = lambda report: report
        self.order = [0, 1, 2]  # of the joints that obey
        self.clock = Clock()
        self.time = self.commanded = self.clock()
        self.angles = np.array([0.1, 0.4, -0.2])
        self.start = self.angles
        self.targets: Any = None
        self.timeout = inf
        self.calls: list[str] = []

    def listen(self) -> RobotState | None:
        """Move on, and report."""
        now = self.clock()
        passed, self.time = now - self.time, now
        if now - self.commanded > self.timeout:
            self.targets = self.start
        before, share = self.angles, passed / (LAG + passed)
        if self.targets is not None:
            self.angles = before + share * (self.targets - before)
        rates = (self.angles - before) / max(passed, 1e-9)
        lean = 0.05 * np.sin(2.0 * now), 0.05 * np.cos(2.0 * now)
        rolling = 0.1 * np.cos(2.0 * now), -0.1 * np.sin(2.0 * now)
        return self.change(
            RobotState(
                now,
                self.angles,
                np.array([*rolling, 0.0]),
                np.array([-9.8 * lean[1], 9.8 * lean[0], 9.8]),
                joint_velocities=rates,
                tilt=lean,
            )
        )

    def command(self, targets: JointTargets) -> None:
        """Take the targets."""
        self.commanded = self.clock()
        self.calls.append("command")
        if self.order:
            self.targets = targets.angles[self.order]

    def release(self) -> None:
        """Note the call."""
        self.calls.append("release")


@pytest.fixture(autouse=True)
def coarse_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """Listen four times in each tick, not twenty times."""
    monkeypatch.setattr(robot_check, "POLL", TICK / 4)


def test_a_correct_robot_of_joints_passes_each_check() -> None:
    robot = HangingRobot()
    found = checked(robot)
    assert failed(found) == {}
    assert found["joints"].text.startswith("3 of 3 joints follow")
    assert found["joints"].value == pytest.approx(LAG, abs=0.04)
    assert found["gyro x"].verdict == found["gyro y"].verdict == "pass"
    assert "holds its targets" in found["without commands"].text
    assert robot.calls[-1] == "release"


def scaled(field: str, factor: float) -> Change:
    """Change of unit or sign."""

    def change(report: RobotState) -> RobotState:
        values: Any = factor * np.array(getattr(report, field))
        return report._replace(**{field: values})

    return change


@pytest.mark.parametrize(
    ("change", "name", "said"),
    [
        (
            scaled("joint_positions", degrees(1.0)),
            "values",
            "is it in degrees",
        ),
        (
            scaled("joint_positions", nan),
            "values",
            "joint_positions must be finite",
        ),
        (scaled("joint_velocities", degrees(1.0)), "hip", "a sign or a unit"),
        (scaled("joint_velocities", -1.0), "knee", "a sign or a unit"),
        (
            scaled("accelerometer", -1.0),
            "accelerometer",
            "must read +9.8 along z",
        ),
        (
            lambda r: r._replace(accelerometer=(0.0, 0.0, 1.0)),
            "accelerometer",
            "is it in [m/s^2]?",
        ),
        (lambda r: r._replace(tilt=(0.5, 0.0)), "tilt", "sign, order or unit"),
        (scaled("gyro", -1.0), "gyro x", "-1.00 times the rate of the tilt"),
        (
            lambda r: r._replace(time=r.time // 0.05),
            "tick",
            "one in each tick is needed",
        ),
        (
            lambda r: r._replace(sighting=Sighting(r.time, 90.0, 1.0)),
            "values",
            "bearing of the sighting",
        ),
    ],
)
def test_a_mistake_in_reports_of_joints_is_found(
    change: Change, name: str, said: str
) -> None:
    robot = HangingRobot()
    robot.change = change
    assert said in failed(checked(robot))[name]


@pytest.mark.parametrize("at", [2.1, 3.2, 6.0])
def test_a_robot_that_falls_silent_is_found(at: float) -> None:
    """While it holds its posture, moves a joint, or later."""
    robot = HangingRobot()
    silent_from = robot.clock() + at
    robot.change = lambda report: report if report.time < silent_from else None
    assert "no new report" in failed(checked(robot))["listen"]
    assert robot.calls[-1] == "release"


@pytest.mark.parametrize(
    ("made", "traits", "said"),
    [
        (KinematicRobot, {"turn_sign": -1.0}, "the sign is wrong"),
        (KinematicRobot, {"stop": lambda: None}, "still turns"),
        (KinematicRobot, {"keeps_walking": False}, "must be True"),
        (KinematicRobot, {"timeout": 0.6}, ""),
        (KinematicRobot, {"change": stays}, ""),
        (HangingRobot, {"order": [0, 2, 1]}, "joints in another order"),
        (
            HangingRobot,
            {"order": [0, 2, 1], "angles": np.array([0.1, 0.4, 0.4])},
            "ankle moved instead",
        ),
        (HangingRobot, {"order": []}, "joints not taken"),
        (HangingRobot, {"keeps_targets": False}, "must be True"),
        (HangingRobot, {"timeout": 0.5}, ""),
    ],
)
def test_a_mistake_of_a_robot_is_found(
    made: Any, traits: dict[str, Any], said: str
) -> None:
    """A robot that is safer than it says only gets a hint."""
    robot = made()
    for name, value in traits.items():
        setattr(robot, name, value)
    found = " ".join(failed(checked(robot)).values())
    assert said in found if said else not found
    assert robot.calls[-1] in ("release", "close")


def off_by(what: str, factor: float) -> Any:
    """Robot with a unit that is wrong by a factor."""
    robot: Any = KinematicRobot()
    start = robot.time
    if what == "pose":
        robot.change = scaled(what, factor)
    elif what == "clock":
        robot.change = lambda r: r._replace(
            time=start + factor * (r.time - start)
        )
    elif what == "drift":
        robot.change = lambda r: r._replace(
            pose=r.pose._replace(x=r.pose.x + factor * (r.time - start))
        )
    else:
        robot = HangingRobot()
        robot.change = scaled(what.replace("targets", "tilt"), factor)
    if what == "targets":
        robot, take = HangingRobot(), HangingRobot.command
        robot.command = lambda told: take(
            robot,
            JointTargets(
                robot.start + factor * (told.angles - robot.start), *told[1:]
            ),
        )
    return robot


@pytest.mark.parametrize(
    ("what", "factors"),
    [
        ("clock", (0.88, 0.92, 1.08, 1.12)),
        ("drift", (0.04, 0.06)),
        ("pose", (0.07, 0.25, 0.35, 1.9, 2.1)),
        ("targets", (0.25, 0.35, 1.9, 2.1)),
        ("gyro", (0.25, 0.35, 1.9, 2.1)),
        ("joint_velocities", (0.25, 0.35, 1.9, 2.1)),
        ("accelerometer", (0.8, 0.85, 1.15, 1.19)),
    ],
)
def test_a_unit_that_is_slightly_wrong_is_judged_as_stored(
    what: str, factors: tuple[float, ...]
) -> None:
    for factor in factors:
        assert checked(off_by(what, factor))
