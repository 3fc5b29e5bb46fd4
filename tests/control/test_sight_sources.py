"""Test the sources of sightings."""

from math import exp
from typing import Any

import numpy as np
import pytest

from fake_robot import FakePerception, measure
from stepaside.control.sensor_sight import CORRECTION, CameraSight
from stepaside.core.constants import GRAVITY
from stepaside.core.poses import Array, Pose
from stepaside.core.rotations import rotation
from stepaside.locomotion.locomotion import CurrentStep, resting_step
from stepaside.perception.measurement import Sighting
from stepaside.planning import Foot

TICK = 0.004
FRAME = Pose(1.0, -2.0, 0.7)


def resting(now: float, foot: Foot = Foot.LEFT) -> CurrentStep:
    return resting_step(FRAME, foot)


def leaning(time: float, roll: float, pitch: float) -> Any:
    """State of a torso that leans and rests."""
    felt: Array = GRAVITY * rotation(roll, pitch, 0.0)[2]
    return measure(time)._replace(accelerometer=felt)


def seeing() -> tuple[CameraSight, FakePerception]:
    eyes: Any = FakePerception()
    return CameraSight(eyes, tick=TICK), eyes


def test_camera_sight_aims_the_head_and_returns_sightings() -> None:
    sight, eyes = seeing()
    assert sight.see(measure(0.0), resting, None) is None
    eyes.seen = Sighting(0.1, 0.2, 1.0)
    assert sight.see(measure(0.1, None), resting, None) is eyes.seen
    eyes.seen = None  # lost is lost: nothing is kept
    assert sight.see(measure(0.2), resting, None) is None
    targets = np.zeros(5)
    sight.aim(targets)
    assert targets[0] == 0.75


@pytest.mark.parametrize("swing", Foot)
def test_cameras_see_over_the_foot_that_stands_at_that_time(
    swing: Foot,
) -> None:
    sight, eyes = seeing()
    asked: list[float] = []

    def step_at(now: float) -> CurrentStep:
        asked.append(now)
        return resting(now, swing)

    sight.see(measure(1.5), step_at, (0.0, 0.0))
    assert eyes.stood == [(FRAME, swing is Foot.RIGHT)]
    assert asked == [1.5]


def test_without_an_estimate_the_attitude_filter_follows_gravity() -> None:
    """Upright at first; d(angle)/dt = k (true - angle) for small angles."""
    sight, eyes = seeing()
    for i in range(round(2.0 / TICK)):
        sight.see(leaning(i * TICK, 0.04, -0.03), resting, None)
    share = 1.0 - exp(-CORRECTION * 2.0)
    assert eyes.tilts[0] == pytest.approx((0.0, 0.0), abs=2e-4)
    expected = (0.04 * share, -0.03 * share)
    assert eyes.tilts[-1] == pytest.approx(expected, rel=5e-3)
    assert CORRECTION == 0.5
