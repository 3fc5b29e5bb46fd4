"""Test the learning of the footsteps' shortfall."""

from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.core.rotations import rotation
from stepaside.locomotion.zmp.current_step import CurrentStep
from stepaside.locomotion.zmp.stride_learning import (
    StrideLearning,
    measured_step,
)
from stepaside.planning import Foot, GaitSettings
from stepaside.robots.forward_kinematics import MeasuredPosture
from stepaside.robots.leg_kinematics import BodyReference

GAIT = GaitSettings()
SUPPORT = Pose(1.0, -2.0, 0.7)
BODY = BodyReference(
    (0.0, 0.0, 0.27), (0.1, 0.2, 0.01, 0.3), (0.4, 0.5, 0.02, 0.6)
)


def posture(
    swing: Foot, stepped: Pose, lean: tuple[float, float, float]
) -> MeasuredPosture:
    """Feet in a torso that leans, the swing foot so far from the other."""
    torso = rotation(*lean).T
    feet = {swing.other: (0.0, 0.0, 0.0), swing: (*stepped[:2], 0.0)}
    yaws = {swing.other: 0.0, swing: stepped.theta}
    order = (Foot.LEFT, Foot.RIGHT)
    return MeasuredPosture(
        np.zeros(3),
        np.array([torso @ feet[f] + (0.1, 0.2, -0.3) for f in order]),
        np.array([torso @ rotation(0.0, 0.0, yaws[f]) for f in order]),
    )


def step(swing: Foot, planned: Pose, **changes: float) -> CurrentStep:
    values: dict[str, Any] = {
        "remaining": -GAIT.double_support,
        "progress": 1.0,
    } | changes
    return CurrentStep(
        SUPPORT, swing, SUPPORT.compose(planned), walking=True, **values
    )


def learner() -> StrideLearning:
    return StrideLearning(GAIT, 0.3, 0.015)


@pytest.mark.parametrize("swing", Foot)
@pytest.mark.parametrize("lean", [(0.0, 0.0, 0.0), (0.2, -0.3, 1.0)])
def test_a_step_is_measured_however_the_torso_leans(
    swing: Foot, lean: tuple[float, float, float]
) -> None:
    stepped = Pose(0.04, swing.value * 0.09, -0.2)
    measured = measured_step(posture(swing, stepped, lean), swing)
    np.testing.assert_allclose(measured, stepped, atol=1e-12)


@pytest.mark.parametrize("swing", Foot)
def test_a_fraction_of_the_shortfall_is_learned(swing: Foot) -> None:
    planned = Pose(0.04, swing.value * 0.1, 0.05)
    made = Pose(0.035, swing.value * 0.1 + 0.01, 0.02)
    stride = learner()
    stride.learn(posture(swing, made, (0.1, 0.1, 0.2)), step(swing, planned))
    expected = 0.3 * np.array([0.005, -0.01, 0.03])
    np.testing.assert_allclose(stride.aim[swing], expected, atol=1e-12)
    np.testing.assert_array_equal(stride.aim[swing.other], 0.0)


def test_aiming_ends_the_shortfall() -> None:
    """A foot always 5 mm and 0.03 rad short of where it is sent."""
    planned = Pose(0.04, 0.1, 0.05)
    stride = learner()
    for _ in range(60):
        x, y, theta = stride.aim[Foot.LEFT].tolist()
        made = Pose(0.035 + x, 0.1 + y, 0.02 + theta)
        where = posture(Foot.LEFT, made, (0.0, 0.0, 0.0))
        stride.learn(where, step(Foot.LEFT, planned))
    aim = stride.aim[Foot.LEFT]
    np.testing.assert_allclose(aim, [0.005, 0.0, 0.03], atol=1e-9)


@pytest.mark.parametrize("swing", Foot)
def test_the_aim_fades_in_with_the_swing(swing: Foot) -> None:
    stride = learner()
    stride.aim[swing] = np.array([0.01, -0.004, 0.05])
    made = step(swing, Pose(0, 0, 0), remaining=0.3, progress=0.25)
    body = stride.aimed(BODY, made)
    x, y = made.from_support(0.0025, -0.001)
    moved, was = body.left_foot, BODY.left_foot
    other, stood = body.right_foot, BODY.right_foot
    if swing is Foot.RIGHT:
        moved, was, other, stood = other, stood, moved, was
    np.testing.assert_allclose(np.subtract(moved, was), [x, y, 0.0, 0.0125])
    assert other == stood and body.com == BODY.com
