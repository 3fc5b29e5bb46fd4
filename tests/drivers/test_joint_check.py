"""Test that the check of a joint-driven robot finds each mistake."""

from collections.abc import Callable
from math import degrees, inf, nan
from typing import Any

import numpy as np
import pytest

from stepaside.drivers import method_check
from stepaside.drivers.joint_check import JointCheck
from stepaside.drivers.method_check import AdapterFinding
from stepaside.drivers.motors import Motors
from stepaside.drivers.robot import JointRobot, JointTargets
from stepaside.perception.measurement import RobotState, Sighting

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
Change = Callable[[RobotState], RobotState | None]


class SteppedClock:
    """Clock that advances where the check pauses."""

    now = 100.0

    def __call__(self) -> float:
        """Time, in [s]."""
        return self.now

    def pause(self, duration: float) -> None:
        """Wait for a time, in [s]."""
        self.now += duration


class HangingRobot(JointRobot):
    """Robot in the air that follows its targets with a lag, and swings."""

    tick, joints = TICK, NAMES

    def __init__(self) -> None:
        self.change: Change = lambda report: report
        self.order = [0, 1, 2]  # of the joints that obey
        self.clock = SteppedClock()
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


class ReleasesItself(HangingRobot):
    """Robot that holds its targets, and denies it."""

    keeps_targets = False


@pytest.fixture(autouse=True)
def coarse_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """Listen four times in each tick, not twenty times."""
    monkeypatch.setattr(method_check, "POLL", TICK / 4)


def checked(
    robot: HangingRobot, *, dry_run: bool = False
) -> dict[str, AdapterFinding]:
    """Check a robot, and return the findings by name."""
    check = JointCheck(
        *(robot, MOTORS, lambda finding: None),
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
        (lambda r: None, "rate", "0 reports"),
        (lambda r: r._replace(time=7.0), "rate", "1 reports with a new time"),
        (lambda r: r._replace(time=1e3 * r.time), "times", "1e+03 times"),
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
def test_a_mistake_in_reports_is_found(
    change: Change, name: str, said: str
) -> None:
    robot = HangingRobot()
    robot.change = change
    assert said in failed(checked(robot))[name]


def test_joints_in_the_wrong_order_are_found() -> None:
    robot = HangingRobot()
    robot.order = [0, 2, 1]
    found = failed(checked(robot))
    assert list(found) == ["hold"]
    assert "when it was to stay: are joints in another order" in found["hold"]
    off = np.abs(robot.angles - robot.start).max()
    assert off < 0.3  # it was released at once
    assert robot.calls[-1] == "release"


def test_joints_of_the_same_angle_in_the_wrong_order_are_found() -> None:
    robot = HangingRobot()
    robot.angles = np.array([0.1, 0.4, 0.4])
    robot.order = [0, 2, 1]
    found = failed(checked(robot))
    assert "ankle moved instead" in found["knee"]
    assert "1 of 3 joints follow" in found["joints"]


def test_joints_that_do_not_obey_are_found() -> None:
    robot = HangingRobot()
    robot.order = []
    assert "joints not taken" in failed(checked(robot))["hip"]


@pytest.mark.parametrize("at", [2.1, 3.2, 6.0])
def test_a_robot_that_falls_silent_is_found(at: float) -> None:
    """While it holds its posture, moves a joint, or later."""
    robot = HangingRobot()
    silent_from = robot.clock() + at
    robot.change = lambda report: report if report.time < silent_from else None
    assert "no new report" in failed(checked(robot))["listen"]
    assert robot.calls[-1] == "release"


def test_whether_the_robot_keeps_its_targets_is_compared() -> None:
    """The safe way round is only a hint."""
    found = failed(checked(ReleasesItself()))
    assert "must be True" in found["without commands"]
    cautious = HangingRobot()
    cautious.timeout = 0.5
    finding = checked(cautious)["without commands"]
    assert finding.verdict == "pass" and "may be False" in finding.text
