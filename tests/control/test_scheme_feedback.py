"""Test the interaction of the control scheme with feedback and perception."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fake_robot import (
    FIRST,
    GAIT,
    STEP,
    TICK,
    FakePerception,
    FakeStrategy,
    Run,
    feeding,
)
from stepaside.control.sensor_sight import CameraSight
from stepaside.locomotion.locomotion import Phase
from stepaside.perception.measurement import Sighting
from stepaside.planning import Direction, Foot


def test_it_waits_until_feedback_is_ready() -> None:
    run, feedback = feeding()
    feedback.ready = False
    run.until(0.5)
    assert run.phase() is Phase.STANDING
    feedback.ready = True
    run.until(0.5 + TICK)
    assert run.phase() is Phase.WALKING


def test_feedback_says_where_a_foot_landed() -> None:
    run, feedback = feeding()
    feedback.shift = 0.01
    scheme = run.until(FIRST + 0.1)
    (landed, step), *_ = feedback.landed
    assert landed == pytest.approx((GAIT.stride, 0.05, 0.0))
    assert step.remaining == pytest.approx(-GAIT.double_support)
    expected = (GAIT.stride + 0.01, 0.05, 0.0)
    assert scheme.walk.plan_frame == pytest.approx(expected)
    assert scheme.walk.left_foot == scheme.walk.plan_frame


def test_a_fallen_robot_stops_moving() -> None:
    run, feedback = feeding()
    feedback.state = SimpleNamespace(has_fallen=False)
    scheme, aimed = run.until(FIRST), list[Any]()
    before = scheme.joint_targets.copy()
    feedback.state = SimpleNamespace(has_fallen=True)
    scheme.senses.aim = aimed.append  # type: ignore[assignment,method-assign]
    run.until(FIRST + 0.2)
    assert aimed == []  # neither does its head
    assert run.phase() is Phase.FALLEN and scheme.walk.plan is None
    np.testing.assert_array_equal(scheme.joint_targets, before)
    steps = len(feedback.steps)
    feedback.state = SimpleNamespace(has_fallen=False)
    run.until(FIRST + 2.0)
    assert run.phase() is Phase.FALLEN and len(feedback.steps) == steps
    assert scheme.begun is None and len(run.steps) == 2


@pytest.mark.parametrize("foot", Foot)
def test_perception_stands_on_the_support_foot(foot: Foot) -> None:
    eyes: Any = FakePerception()
    run = Run(senses=CameraSight(eyes, tick=TICK), first_foot=foot)
    scheme = run.until(0.1, distance=1.0)
    assert run.phase() is Phase.STANDING  # only what is seen counts
    eyes.seen = Sighting(0.1, 0.2, 1.0)
    run.until(0.1 + TICK, bearing=9.0)
    assert run.asked == pytest.approx([0.2])
    assert scheme.sighting == eyes.seen
    assert scheme.joint_targets[0] == 0.75
    run.until(0.1 + FIRST + 0.1)
    left = foot is Foot.RIGHT  # the left one stands while the right swings
    support = scheme.walk.left_foot if not left else scheme.walk.right_foot
    assert eyes.stood[0][1] is left
    assert eyes.stood[-1] == (support, not left)
    eyes.seen = None
    run.until(0.1 + FIRST + STEP + 0.1)
    assert run.phase() is Phase.HALTING


@pytest.mark.parametrize("turning", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize("direction", Direction)
def test_eyes_that_look_around_turn_the_body(
    direction: Direction, turning: float
) -> None:
    """On the spot, to see the floor behind it; then it plays on."""
    eyes: Any = FakePerception()
    eyes.head.turning = turning
    run = Run(
        FakeStrategy(direction=direction), senses=CameraSight(eyes, tick=TICK)
    )
    scheme = run.until(FIRST + 2.5 * STEP, distance=None)
    assert run.phase() is (Phase.WALKING if turning else Phase.STANDING)
    assert run.asked == []
    if not turning:
        return
    landed = 0.5 * (
        np.array(scheme.walk.left_foot) + np.array(scheme.walk.right_foot)
    )
    assert landed[2] == pytest.approx(turning * 2.5 * 0.08 * np.pi, abs=0.01)
    assert np.hypot(*landed[:2]) < 0.02
    eyes.head.turning, eyes.seen = 0.0, Sighting(0.0, 0.2, 1.0)
    run.until(FIRST + 3.5 * STEP, distance=None)
    assert run.phase() is Phase.WALKING and len(run.asked) == 1
    eyes.seen = None
    run.until(FIRST + 4.5 * STEP, distance=None)
    assert run.phase() is Phase.HALTING
