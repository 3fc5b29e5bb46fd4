"""Test that a robot of the documents walks until a sensor fails.

The robot is the documents' example: NAO in a MuJoCo loop of its own. Its clock
is that of the computer here, so that silence counts as on a real robot.
"""

from collections.abc import Callable
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.drivers.joint_loop import JointLoop
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.motors import motors_of
from stepaside.drivers.robot_loader import load_robot_class
from stepaside.drivers.robot_session import RobotSession
from stepaside.drivers.safety import SafetyState
from stepaside.drivers.scheme_factory import scheme_factory
from stepaside.locomotion.control_settings import STABILISED
from stepaside.perception.measurement import RobotState
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.strategies import Evasion

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "adapters" / "mujoco_robot.py"
PAGE = ROOT / "docs" / "connect-your-robot.md"
BEGIN, LONGEST = 3.0, 3.0  # of a fault, while it walks, in [s]
KNEE = 15  # one of the motors of NAO
Report = RobotState | None


def jumping(report: RobotState, kept: RobotState) -> Report:
    angles = np.array(report.joint_positions)
    angles[KNEE] += 0.8
    return report._replace(joint_positions=angles)


# What is wrong, and how it is named.
FAULTS: dict[str, tuple[Callable[[RobotState, RobotState], Report], str]] = {
    "joint jumping": (jumping, "jumped by"),
    "the same report again": (
        lambda report, kept: kept,
        "returned no new report for",
    ),
    "forces missing": (
        lambda report, kept: report._replace(foot_forces=np.full(8, nan)),
        "foot_forces are needed",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_ends_in_a_stop_that_is_named(name: str) -> None:
    change, said = FAULTS[name]
    example: Any = load_robot_class(f"{EXAMPLE}:MujocoRobot")

    class Faulty(example):  # type: ignore[misc]
        paced = True
        kept: RobotState

        def listen(self) -> Report:
            report: RobotState = super().listen()
            if report.time < BEGIN:
                self.kept = report
                return report
            if name == "joint jumping" and report.time > BEGIN + 0.02:
                return report
            return change(report, self.kept)

    robot, nao = Faulty(), load_robot("nao")

    def clock() -> float:
        return float(robot.data.time) if hasattr(robot, "data") else 0.0

    loop = JointLoop(
        lambda: RobotSession(robot, clock=clock),
        motors_of(robot, nao),
        Evasion(safety_radius=3.0),
        scheme_factory(
            nao, GaitSettings(), STABILISED, tick=robot.tick, delay_ticks=0
        ),
        needs_forces=True,
        clock=clock,
        pause=lambda duration: None,
    )
    stopped = ""
    try:
        while clock() < BEGIN + LONGEST and not stopped:
            tick = loop.tick()
            walks = tick.state is SafetyState.WALKING
            assert walks or clock() > BEGIN - 1e-6 or clock() < 0.5
            if clock() > BEGIN and not walks:
                stopped = tick.reason
        assert tick.state is (
            SafetyState.STOPPING
            if name == "joint jumping"
            else SafetyState.LIMP
        )
    except SessionLost as lost:
        stopped = str(lost)
        assert loop.state is SafetyState.LIMP
    assert said in stopped
    assert clock() < BEGIN + 1.0
    loop.close()
    page = PAGE.read_text(encoding="utf-8")
    named = [row.split(" | ")[2] for row in page.splitlines()
             if row.count(" | ") == 3]  # fmt: skip
    assert any(said in row for row in named)


def test_the_page_prints_the_example() -> None:
    code = EXAMPLE.read_text(encoding="utf-8")
    assert len(code.splitlines()) <= 120
    assert f"```python\n{code}```" in PAGE.read_text(encoding="utf-8")
