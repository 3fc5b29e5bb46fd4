"""Test the template controller, and the timing of its reports."""

from math import atan2, hypot, pi
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fake_robot import FakeStrategy
from stepaside.core.poses import Pose, wrap_angle
from stepaside.drivers.velocity_loop import TemplateController
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import Direction, GaitSettings
from stepaside.strategies import Intent

GAIT = GaitSettings()
ANGLE = st.floats(-pi, pi)
PERIOD = 0.05


def way(time: float, start: Pose, rate: float) -> Pose:
    """Pose of a robot that walks on an arc."""
    return start.compose(Pose(0.3 * time, -0.1 * time, rate * time))


@given(ANGLE, st.floats(-1.5, 1.5), st.integers(0, 12), st.booleans())
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


class SlowStrategy(FakeStrategy):
    """Strategy that walks at half the pace."""

    def decide(self, knowledge: Any, memory: Any) -> Any:
        """Want a heading at half the pace."""
        return Intent(0.4, pace=0.5), None


def test_the_pace_slows_speed_and_turn_alike() -> None:
    mind = TemplateController(SlowStrategy(), GAIT)
    ahead = Sighting(0.0, 0.0, 1.0)
    told = mind.decide(
        RobotState(0.0, pose=Pose(0.0, 0.0, 0.0), sighting=ahead)
    )
    assert told == pytest.approx((0.5 * GAIT.speed, 0, 0.5 * GAIT.gain * 0.4))
