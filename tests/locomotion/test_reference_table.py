"""Test the references of a plan at the control ticks."""

from math import pi

import numpy as np
import pytest

from stepaside.core.poses import Array, Pose
from stepaside.locomotion.zmp.reference_table import (
    ReferenceSample,
    ReferenceTable,
    standing_reference,
)
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.maneuver import landing_state

GAIT = GaitSettings()
TICK = 0.004
FRAME = Pose(1.0, -2.0, 0.7)


def plan(
    foot: Foot = Foot.LEFT, bearing: float = 0.5, standing: bool = False
) -> ManeuverPlan:
    return ManeuverPlanner(GAIT).plan(
        bearing,
        Direction.FORWARD,
        first_foot=foot,
        state=CenterState((0.01, 0.03), (0.05, -0.1)),
        swing_start=Pose(-0.03, foot.value * 0.1, 0.05),
        standing=standing,
    )


def in_odometry(points: Array) -> Array:
    """Points or poses of the plan's frame, one row."""
    c, s = np.cos(FRAME.theta), np.sin(FRAME.theta)
    turned = np.array([[c, -s], [s, c]]) @ points[:2] + FRAME[:2]
    return np.concatenate([turned, points[2:] + FRAME.theta])


def check(row: ReferenceSample, made: ManeuverPlan, passed: float) -> None:
    """Compare a row with the plan at a time since it began."""
    at = made.sample([passed])
    np.testing.assert_allclose(row.body.com[:2], in_odometry(at.com[0]))
    assert row.body.com[2] == GAIT.com_height
    np.testing.assert_allclose(row.zmp, in_odometry(at.zmp[0]), atol=1e-12)
    np.testing.assert_allclose(row.dcm, in_odometry(at.dcm[0]), atol=1e-12)
    for asked, foot, height in (
        (row.body.left_foot, at.left_foot[0], at.left_height[0]),
        (row.body.right_foot, at.right_foot[0], at.right_height[0]),
    ):
        x, y, yaw = in_odometry(foot)
        np.testing.assert_allclose(asked, [x, y, height, yaw], atol=1e-12)


@pytest.mark.parametrize("started", [0.0, 1.0, 1.0013, 1.0039999, 2.5])
@pytest.mark.parametrize("foot", Foot)
def test_rows_are_the_plan_at_the_ticks(started: float, foot: Foot) -> None:
    """A plan begins between ticks: gait time stays exact all the same."""
    made = plan(foot)
    duration = made.schedule.first_step_duration
    table = ReferenceTable(TICK)
    table.load(made, FRAME, started, duration)
    first = int(np.ceil(started / TICK - 1e-6))
    for tick in range(first, int((started + duration) / TICK)):
        if (tick - first) % 9 == 0:
            check(table.at(tick * TICK), made, tick * TICK - started)


def test_times_that_are_rounded_find_their_tick() -> None:
    made = plan()
    table = ReferenceTable(TICK)
    table.load(made, FRAME, 5.0 * TICK + 1e-12, 0.3)
    row = table.at(5.0 * TICK)
    check(row, made, 0.0)
    assert table.at(5.0 * TICK + 1e-9) == row
    assert table.at(6.0 * TICK - 1e-9) == table.at(6.0 * TICK)


@pytest.mark.parametrize("foot", Foot)
def test_com_at_the_end_of_a_step_is_that_of_the_plan(foot: Foot) -> None:
    """In the frame of the foot that landed."""
    made = plan(foot)
    frame = Pose(*made.placements[2].tolist())
    position, velocity = landing_state(made)
    end = made.sample([made.schedule.first_step_duration])
    back = np.array(
        [
            [np.cos(frame.theta), np.sin(frame.theta)],
            [-np.sin(frame.theta), np.cos(frame.theta)],
        ]
    )
    np.testing.assert_allclose(position, back @ (end.com[0] - frame[:2]))
    np.testing.assert_allclose(velocity, back @ end.com_velocity[0])


def test_standing_com_is_midway_between_the_anchors() -> None:
    """Each anchor lies ahead of its foot, along its heading."""
    left, right = Pose(1.0, 2.0, 0.0), Pose(1.1, 1.9, 0.5 * pi)
    body = standing_reference(left, right, GAIT)
    ahead = GAIT.zmp_forward
    expected = (1.05 + 0.5 * ahead, 1.95 + 0.5 * ahead, GAIT.com_height)
    assert body.com == pytest.approx(expected)
    assert body.left_foot == (1.0, 2.0, 0.0, 0.0)
    assert body.right_foot == (1.1, 1.9, 0.0, 0.5 * pi)
