"""Test the control scheme of one robot with a fake body."""

import numpy as np
import pytest

from fake_robot import FIRST, GAIT, STEP, TICK, FakeStrategy, Run
from stepaside.core.poses import Pose
from stepaside.locomotion.locomotion import Phase
from stepaside.locomotion.maneuver_walk import SETTLING
from stepaside.planning import Foot


def test_it_stands_midway_until_the_other_is_a_reason() -> None:
    run = Run()
    scheme = run.scheme
    half = 0.5 * GAIT.foot_spacing
    assert scheme.walk.left_foot == Pose(0.0, half, 0.0)
    assert scheme.walk.right_foot == Pose(0.0, -half, 0.0)
    com = (GAIT.zmp_forward, 0.0, GAIT.com_height)
    np.testing.assert_allclose(scheme.joint_targets, com, atol=1e-15)
    assert scheme.walk.plan_frame == Pose(0.0, 0.0, 0.0)
    assert scheme.walk.plan_started == 0.0
    run.until(1.0, distance=None)
    run.until(2.0, distance=2.1)
    assert run.phase() is Phase.STANDING and scheme.walk.plan is None
    assert run.steps == [] and scheme.begun is None
    assert scheme.walk.reference.com == pytest.approx(com, abs=1e-15)
    assert scheme.walk.planned_centers[2:] == pytest.approx(com[:2], abs=1e-15)
    run.until(2.0 + TICK, distance=1.9)
    assert run.phase() is Phase.WALKING and run.replans == 1


@pytest.mark.parametrize("foot", Foot)
def test_feet_land_alternately_from_the_first_foot(foot: Foot) -> None:
    run = Run(first_foot=foot)
    run.until(FIRST + 2.5 * STEP)
    times, feet, poses = zip(*run.landings, strict=True)
    assert feet == (foot, foot.other, foot, foot.other)
    landed = FIRST - GAIT.double_support + STEP * np.arange(4)
    np.testing.assert_allclose(times, landed)
    for i, pose in enumerate(poses):
        side = 0.5 * GAIT.foot_spacing * feet[i].value
        expected = ((i + 1) * GAIT.stride, side, 0.0)
        assert pose == pytest.approx(expected, abs=1e-12)


def test_gait_time_is_exact_though_steps_end_between_ticks() -> None:
    run = Run()
    scheme = run.until(FIRST + 4.2 * STEP)
    assert scheme.walk.plan_started == pytest.approx(
        FIRST + 4.0 * STEP, abs=1e-9
    )
    assert run.replans == 6
    begins = [0.0, *(FIRST + STEP * np.arange(5))]
    np.testing.assert_allclose([s.started for s in run.steps], begins)


def test_a_maneuver_turns_the_robot_as_the_template() -> None:
    """Each plan is made in the frame of its support foot."""
    run = Run(FakeStrategy(heading=0.5))
    scheme = run.until(FIRST + 3.5 * STEP)
    turn = GAIT.gain * 0.5 * GAIT.path_interval
    headings = [pose.theta for _, _, pose in run.landings]
    np.testing.assert_allclose(headings, turn * np.arange(1, 6))
    plan = scheme.walk.plan
    assert plan is not None and plan.bearing == 0.5
    assert scheme.walk.plan_frame.theta == pytest.approx(headings[3])


def test_the_reference_is_continuous_through_all_plans() -> None:
    run = Run(FakeStrategy(heading=0.8))
    coms, zmps = [], []
    while run.ticks * TICK < FIRST + 3.0 * STEP:
        scheme = run.until((run.ticks + 1) * TICK)
        coms.append(scheme.walk.reference.com)
        zmps.append(scheme.walk.planned_centers[2:])
    speed = np.diff(coms, axis=0) / TICK
    assert np.abs(speed).max() < 0.4
    assert np.abs(np.diff(speed, axis=0)).max() < 0.03
    assert np.abs(np.diff(zmps, axis=0)).max() < 0.006
    assert len(run.steps) == run.replans == 4
    assert max(step.velocity_jump for step in run.steps) < 1e-12
    assert len(run.legs.tracked) == run.ticks


def test_the_bearing_counts_from_the_path_where_the_body_is() -> None:
    """Seen from the torso; of the first turn less than 0.7 is walked then."""
    run = Run(FakeStrategy(heading=0.5))
    run.legs.torso_heading = 0.2
    run.until(TICK, bearing=0.1)
    assert run.asked == pytest.approx([0.3])
    run.until(FIRST + 0.1, bearing=-0.3)
    walked = -0.3 + 0.2 - run.asked[1]
    assert 0.6 < walked / run.landings[0][2].theta < 0.7
    (_, known) = run.scheme.decisions.memory
    assert known.pose_in_map.theta == pytest.approx(walked)
    assert 0.6 < known.pose_in_map.x / GAIT.stride < 0.7


def test_without_a_reason_it_brings_its_feet_abreast_and_rests() -> None:
    run = Run(FakeStrategy(heading=0.5))
    run.until(FIRST - 0.1)
    run.strategy.going = False
    scheme = run.until(FIRST + 0.1)
    assert run.phase() is Phase.HALTING
    ends = FIRST + STEP + SETTLING
    run.until(ends - 2 * TICK)
    assert run.phase() is Phase.HALTING
    assert scheme.locomotion.step(ends).walking
    run.until(ends + 2 * TICK)
    assert run.phase() is Phase.STANDING and scheme.walk.plan is None
    apart = scheme.walk.right_foot.inverse().compose(scheme.walk.left_foot)
    expected = (0.0, GAIT.foot_spacing, 0.0)
    assert apart == pytest.approx(expected, abs=1e-12)
    assert scheme.walk.left_foot == run.landings[0][2]
    assert scheme.walk.right_foot == run.landings[1][2]
    assert len(run.steps) == 2 and run.replans == 1  # a halt is no maneuver
    before = run.legs.tracked[-3].com
    assert scheme.walk.reference.com == pytest.approx(before, abs=1e-3)
    assert scheme.walk.planned_centers[2:] == scheme.walk.reference.com[:2]
    assert not scheme.locomotion.step(ends).walking
    assert SETTLING == 1.0
