"""Test the example of a robot in a MuJoCo loop of its own, and its faults."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from stepaside.drivers.joint_loop import JointLoop
from stepaside.drivers.joint_motion import motors_of
from stepaside.drivers.robot_loader import load_robot_class
from stepaside.drivers.robot_session import RobotSession
from stepaside.drivers.safety import SafetyState
from stepaside.drivers.scheme_factory import scheme_factory
from stepaside.locomotion.control_settings import STABILISED
from stepaside.perception.measurement import RobotState
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.robots.tree_cache import load_tree
from stepaside.strategies import Evasion

EXAMPLE = Path(__file__).parents[2] / "examples/adapters/mujoco_robot.py"
NAO = load_robot("nao")
# What becomes of a report, by it and the last one without a fault.
Fault = Callable[[RobotState, RobotState], RobotState]


class Play:
    """The example, on the paper's gait; its reports may be replaced."""

    def __init__(self) -> None:
        make = load_robot_class(f"{EXAMPLE}:MujocoRobot")
        self.robot = cast(Any, make())
        self._listen, self.robot.listen = self.robot.listen, self.listen
        self.fault: Fault | None = None
        self._last: RobotState | None = None
        self.loop = JointLoop(
            lambda: RobotSession(self.robot),
            motors_of(self.robot, NAO),
            Evasion(safety_radius=5.0),
            scheme_factory(
                NAO, GaitSettings(), STABILISED, tick=0.012, delay_ticks=0
            ),
            needs_forces=True,
        )

    def listen(self) -> RobotState:
        """Return a report, or what the fault makes of it."""
        report: RobotState = self._listen()
        if self.fault is not None and self._last is not None:
            return self.fault(report, self._last)
        self._last = report._replace(  # the data of MuJoCo change
            gyro=report.gyro.copy(), accelerometer=report.accelerometer.copy()
        )
        return report

    def until(self, state: SafetyState, ticks: int) -> str:
        """Play until the robot is in a state; return the reason."""
        for _ in range(ticks):
            self.loop.tick()
            if self.loop.state is state:
                return self.loop.reason
        raise AssertionError(f"{self.loop.state}: {self.loop.reason}")


@pytest.fixture
def play() -> Iterator[Play]:
    """A robot that walks."""
    made = Play()
    made.until(SafetyState.WALKING, 600)
    for _ in range(150):  # from the start to its first steps
        made.loop.tick()
    assert made.loop.state is SafetyState.WALKING
    yield made
    made.fault = None
    made.loop.close()


def slipped(report: RobotState, last: RobotState) -> RobotState:
    """The encoder of a knee slips."""
    knee = np.array(load_tree(NAO).motors) == "LKneePitch"
    angles = report.joint_positions + 0.8 * knee
    return report._replace(joint_positions=angles)


STOPS: dict[str, tuple[Fault, str]] = {
    "frozen": (
        lambda report, last: last._replace(
            time=report.time, sighting=report.sighting
        ),
        "accelerometer reading is constant while the legs move",
    ),
    "jumping": (slipped, "LKneePitch jumped by 0."),
}


@pytest.mark.parametrize("fault", STOPS)
def test_a_sensor_that_fails_stops_the_walk_by_name(
    fault: str, play: Play
) -> None:
    """The robot stands, within 2.4 s."""
    play.fault, said = STOPS[fault]
    assert said in play.until(SafetyState.STOPPING, 200)


def test_a_torso_that_tilts_is_released(play: Play) -> None:
    play.fault = lambda report, last: report._replace(tilt=(0.8, 0.0))
    assert "the robot falls" in play.until(SafetyState.LIMP, 3)
