"""Test the pose of the template unicycle of a walking body."""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.planning import Direction, Foot, GaitSettings, ManeuverPlanner
from stepaside.planning.path import (
    path_samples,
    poses_on_path,
    progress_by_time,
)
from stepaside.planning.push_bound import steady_plan

GAIT = GaitSettings()
STEP = GAIT.step_duration
UNTIMED = np.array([[np.nan]])
LED = replace(GAIT, zmp_forward=0.02)


def circle(count: int, turn: float, stride: float) -> Array:
    """Poses on a circle, one step apart; backward for negative strides."""
    radius = stride / turn
    theta = turn * np.arange(count)
    return np.column_stack(
        [radius * np.sin(theta), radius * (1.0 - np.cos(theta)), theta]
    )


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("turn", [0.06, -0.06])
def test_position_and_heading_follow_the_com(turn: float, way: float) -> None:
    """The CoM is ahead of the place, whichever way it goes."""
    path = circle(4, turn, 0.04 * way)
    for step in range(3):
        for share in (0.0, 0.2, 0.5, 0.9):
            place = path[step] + share * (path[step + 1] - path[step])
            theta = path[step, 2] + 0.5 * turn
            com = place[:2] + 0.02 * np.array([cos(theta), sin(theta)])
            (found,) = poses_on_path(path, com[None], UNTIMED, LED)
            np.testing.assert_allclose(found, place, atol=1e-4)


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("bearing", [0.8, -0.8])
def test_a_body_passes_its_sample_in_the_middle_of_single_support(
    direction: Direction, bearing: float
) -> None:
    """A gait is the same backward in time: half before, half after."""
    plan = steady_plan(
        ManeuverPlanner(GAIT), bearing, direction, first_foot=Foot.LEFT
    )
    middle = 0.5 * GAIT.single_support
    apart = np.array([0.02, 0.1, 0.2, 0.21])
    samples = path_samples(plan.placements, Foot.LEFT, GAIT.foot_spacing)
    headings = [
        poses_on_path(
            samples,
            plan.sample(times).com,
            progress_by_time(plan.schedule, np.array(times)),
            GAIT,
        )[:, 2]
        for times in ([middle], middle + apart, middle - apart)
    ]
    turn = plan.placements[2, 2]
    assert abs(turn) == pytest.approx(0.08 * 0.8)
    # To first order in the turn, over which the sway leans.
    np.testing.assert_allclose(headings[0], 0.0, atol=0.02 * abs(turn))
    np.testing.assert_allclose(
        headings[1] + headings[2], 0.0, atol=0.05 * abs(turn)
    )


@pytest.mark.parametrize("speed", [0.05, 0.3, 0.5, 1.0])
@pytest.mark.parametrize("bearing", [pi, -pi])
def test_a_body_that_turns_has_the_heading_between_its_feet(
    bearing: float, speed: float
) -> None:
    """On the spot too, where it sways by more than it goes."""
    gait = replace(GAIT, speed=speed * GAIT.speed, stride=speed * GAIT.stride)
    plan = steady_plan(
        ManeuverPlanner(gait),
        bearing,
        Direction.BACKWARD,
        first_foot=Foot.LEFT,
    )
    times = np.linspace(0.0, STEP, 40)
    samples = path_samples(plan.placements, Foot.LEFT, GAIT.foot_spacing)
    poses = poses_on_path(
        samples,
        plan.sample(times).com,
        progress_by_time(plan.schedule, times),
        GAIT,
    )
    # The middle of a support is half a single support after it begins.
    passed = (times - 0.5 * GAIT.single_support) / STEP
    turn = plan.placements[2, 2]
    assert abs(turn) == pytest.approx(0.08 * pi)
    assert np.abs(poses[:, 2] - passed * turn).max() < 0.35 * abs(turn)
