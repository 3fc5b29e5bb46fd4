"""Test footstep commands along the template's path."""

from math import cos, sin

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.drivers.velocity.footstep_commands import (
    StepLimits,
    path_segment_of,
    plan_footsteps,
)
from stepaside.drivers.velocity.velocity_body import VelocityCommand
from stepaside.planning import Direction, Foot, GaitSettings, ManeuverPlanner

GAIT = GaitSettings()
WIDE = StepLimits(stride=1.0, turn=1.5)
FEET = list(Foot)


@pytest.mark.parametrize("foot", FEET)
@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("bearing", [-2.0, 0.0, 0.7])
def test_footsteps_are_those_of_the_papers_maneuver(
    foot: Foot, direction: Direction, bearing: float
) -> None:
    maneuver = ManeuverPlanner(GAIT).plan(
        bearing, direction, first_foot=foot, standing=True
    )
    velocity = VelocityCommand(
        direction.value * GAIT.speed, GAIT.gain * bearing
    )
    steps = plan_footsteps(velocity, GAIT, WIDE, first_foot=foot, count=4)
    placed = Pose(0.0, 0.0, 0.0)
    for step, row in zip(steps, maneuver.placements[2:], strict=False):
        placed = placed.compose(step.pose)
        assert placed == pytest.approx(tuple(row), abs=1e-12)
    assert [step.foot for step in steps] == 2 * [foot, foot.other]


@pytest.mark.parametrize("foot", FEET)
@pytest.mark.parametrize(("stride", "turn"), [(0.01, 1.0), (0.3, 0.02)])
def test_steps_beyond_the_limits_are_shortened_along_the_path(
    foot: Foot, stride: float, turn: float
) -> None:
    """The circle keeps its radius: length over turn stays."""
    velocity = VelocityCommand(-0.1, 0.15)
    limits = StepLimits(stride=stride, turn=turn)
    steps = plan_footsteps(velocity, GAIT, limits, first_foot=foot, count=3)
    for step in steps:
        length, turned, aside = path_segment_of(
            step.pose, step.foot, GAIT.foot_spacing
        )
        assert length / turned == pytest.approx(-0.1 / 0.15)
        assert aside == pytest.approx(0.0, abs=1e-12)
        spent = max(abs(length) / stride, abs(turned) / turn)
        assert spent == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("durations", "period"), [((0.425, 0.122), 0.547), ((0.2, 0.1), 0.42)]
)
def test_steps_take_the_time_of_the_gait_as_far_as_the_robot_has_it(
    durations: tuple[float, float], period: float
) -> None:
    single, double = durations
    gait = GaitSettings(single_support=single, double_support=double)
    steps = plan_footsteps(
        VelocityCommand(0.1, 0.0),
        gait,
        StepLimits(),
        first_foot=FEET[0],
        count=3,
    )
    times = [step.time for step in steps]
    assert times == pytest.approx([period, 2 * period, 3 * period])


@pytest.mark.parametrize("foot", FEET)
@pytest.mark.parametrize("turn", [-0.3, 1e-9, 0.2])
def test_a_stride_is_the_arc_beside_which_the_foot_lands(
    foot: Foot, turn: float
) -> None:
    radius, half = 0.05 / turn, 0.05 * foot.value
    end = Pose(radius * sin(turn), radius * (1.0 - cos(turn)), turn)
    landed = Pose(0.0, half, 0.0).compose(end).compose(Pose(0.0, half, 0.0))
    stride = path_segment_of(landed, foot, 0.1)
    assert stride == pytest.approx((0.05, turn, 0.0), abs=1e-9)
    beside = landed.compose(Pose(0.0, 0.03, 0.0))
    assert path_segment_of(beside, foot, 0.1).lateral == pytest.approx(
        0.03, rel=0.1
    )


def test_turning_in_place_has_no_displacement() -> None:
    steps = plan_footsteps(
        VelocityCommand(0.0, 0.2),
        GAIT,
        StepLimits(),
        first_foot=FEET[0],
        count=2,
    )
    length, turn, _ = path_segment_of(
        steps[0].pose, FEET[0], GAIT.foot_spacing
    )
    assert length == pytest.approx(0.0, abs=1e-6)
    assert turn == pytest.approx(0.08)


@pytest.mark.parametrize(
    "wrong", [{"stride": 0.0}, {"turn": -1.0}, {"longest": 0.1}]
)
def test_limits_that_let_nothing_through_are_refused(
    wrong: dict[str, float],
) -> None:
    with pytest.raises(ConfigurationError, match=next(iter(wrong))):
        StepLimits(**wrong)
