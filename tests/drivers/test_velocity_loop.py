"""Test the template controller, and its loop with a fake robot."""

import io
from math import atan2, hypot, pi
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fake_robot import FakeStrategy
from stepaside.core.poses import Pose, wrap_angle
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.play_log import PlayTick, StatusLine
from stepaside.drivers.robot import REST, VelocityLimits
from stepaside.drivers.velocity_loop import (
    DrivingState,
    TemplateController,
    VelocityLoop,
)
from stepaside.drivers.watchdog import Watchdog
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import Direction, GaitSettings
from stepaside.strategies import Evasion, Pursuit, Strategy
from stepaside.strategies.velocity_set import BodyVelocity

from velocity_fakes import PERIOD, FakeWalker, report  # isort: skip

GAIT = GaitSettings()
REPORTS = [report(PERIOD * i) for i in range(40)]


def playing_of(
    robot: Any, strategy: Any = None, *, paced: bool = True, wait: float = 9.0
) -> VelocityLoop:
    return VelocityLoop(
        robot,
        lambda: TemplateController(strategy or Pursuit(), GAIT),
        VelocityLimits(),
        watchdog=Watchdog(paced=paced),
        wait=wait,
        clock=robot.clock,
        pause=robot.pause,
    )


def played(robot: FakeWalker, ticks: int, **settings: Any) -> list[PlayTick]:
    playing = playing_of(robot, **settings)
    return [playing.tick() for _ in range(ticks)]


@pytest.mark.parametrize(
    ("strategy", "wanted"),
    [
        (Pursuit(), BodyVelocity(0.1, 0.0, 0.2 * 0.4)),
        (Pursuit(saturated=True), BodyVelocity(0.1, 0.0, 0.2)),
        (
            Evasion(safety_radius=2.0),
            BodyVelocity(-0.1, 0.0, 0.2 * (0.4 - pi / 2)),
        ),
        (Evasion(safety_radius=0.5), REST),
    ],
)
def test_the_controller_commands_the_templates_velocity(
    strategy: Strategy, wanted: BodyVelocity
) -> None:
    mind = TemplateController(strategy, GAIT)
    assert mind.decide(REPORTS[3]) == pytest.approx(wanted)
    assert mind.moving == (wanted != REST)


def test_without_a_sighting_the_command_is_zero() -> None:
    mind = TemplateController(Pursuit(), GAIT)
    mind.decide(REPORTS[0])
    assert mind.decide(report(0.1, sighting=None)) == REST and not mind.moving


def way(time: float, start: Pose, rate: float) -> Pose:
    """Pose of a robot that walks on an arc."""
    return start.compose(Pose(0.3 * time, -0.1 * time, rate * time))


@given(
    st.floats(-pi, pi), st.floats(-1.5, 1.5), st.integers(0, 12), st.booleans()
)
def test_an_old_sighting_is_of_where_the_robot_was_then(
    heading: float, rate: float, late: int, saturated: bool
) -> None:
    """Latency does not move an opponent that stands still."""
    strategy = FakeStrategy(
        heading=0.4, direction=Direction.BACKWARD, saturated=saturated
    )
    start, other = Pose(0.5, -0.2, heading), Pose(1.4, 0.3, 0.0)
    mind = TemplateController(strategy, GAIT)
    for i in range(40):
        now, taken = PERIOD * i, PERIOD * max(0, i - late)
        then = way(taken, start, rate)
        x, y, _ = then.inverse().compose(other)
        seen = Sighting(taken, wrap_angle(atan2(y, x)), hypot(x, y))
        told = mind.decide(
            RobotState(now, pose=way(now, start, rate), sighting=seen)
        )
    assert told.forward == pytest.approx(-GAIT.speed)
    turn = GAIT.gain * (1.0 if saturated else 0.4)
    assert told.turn == pytest.approx(turn)


def test_the_clock_of_a_simulator_may_pause_for_any_time() -> None:
    later = [report(PERIOD * i) for i in range(20, 40)]
    robot = FakeWalker([*REPORTS[:20], *400 * [None], *later])
    ticks = played(robot, 440, paced=False)  # 20 s
    assert ticks[300].state is ticks[-1].state is DrivingState.WALKING
    for i, stands in ((70, False), (85, True), (300, True), (439, False)):
        assert ("clock stands still" in ticks[i].reason) is stands


@pytest.mark.parametrize("wait", [3.0, 15.0])
def test_a_robot_is_waited_for_as_long_as_wanted(wait: float) -> None:
    robot = FakeWalker([])
    with pytest.raises(SessionLost, match=f" {wait:g} s: no odometry receive"):
        played(robot, 400, paced=wait > 9.0, wait=wait)
    assert robot.now == pytest.approx(500.0 + wait, abs=3.0 * PERIOD)


class HungUp(io.StringIO):
    """Terminal that is gone."""

    def write(self, text: str) -> int:
        """Fail as the system does."""
        raise OSError("Input/output error")


def test_a_terminal_that_hung_up_does_not_end_the_walk() -> None:
    StatusLine(HungUp()).note(played(FakeWalker(REPORTS), 1)[0])


def test_the_status_line_has_the_time_since_the_first_report() -> None:
    stream = io.StringIO()
    line = StatusLine(stream)
    for tick in played(FakeWalker(REPORTS), 3):
        line.note(tick._replace(time=1.7e9 + tick.time))
    assert stream.getvalue().startswith("    0.0 s ")


def test_a_strategy_that_fails_ends_in_rest() -> None:
    class Broken(Pursuit):
        """It cannot decide."""

        def decide(self, knowledge: Any, memory: Any) -> Any:
            """Fail."""
            raise KeyError("side")

    robot = FakeWalker(REPORTS)
    playing = playing_of(robot, Broken())
    for _ in range(6):
        tick = playing.tick()
    assert tick.state is DrivingState.RESTING and "side" in tick.reason
    assert set(robot.asked) == {REST}
