"""Test the laws of the paper against its equations and the theory."""

from math import copysign, cos, inf, pi, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.core.poses import wrap_angle
from stepaside.theory import laws

ANGLES = st.floats(-pi, pi)


@pytest.mark.parametrize("bearing", [-0.3, 0.0, 0.2])
def test_side_plus_one_is_eq_5_as_printed(bearing: float) -> None:
    """theta_eva = theta_aim - pi/2, with theta_aim = psi + theta_e - pi."""
    heading = laws.evasion_heading(bearing, 1, pi / 2)
    printed = (bearing - pi) - pi / 2
    assert wrap_angle(heading - printed) == pytest.approx(0.0, abs=1e-15)


@given(ANGLES)
def test_moving_aside_is_across_the_line_of_sight_and_behind(
    bearing: float,
) -> None:
    """Sec. II-B: of the two normals take the one behind the robot."""
    side = laws.side_behind(bearing)
    heading = laws.evasion_heading(bearing, side, pi / 2)
    motion = (-cos(heading), -sin(heading))
    along = motion[0] * cos(bearing) + motion[1] * sin(bearing)
    assert along == pytest.approx(0.0, abs=1e-12)
    assert motion[0] <= 1e-12


def test_straight_ahead_the_side_is_that_of_eq_5() -> None:
    assert laws.side_behind(0.0) == laws.side_behind(-0.0) == 1
    assert laws.side_behind(1e-300) == -1


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("past", [0.0, pi])
def test_side_changes_beyond_the_hysteresis_at_both_ends(
    side: int, past: float
) -> None:
    """At psi = 0 and at psi = pi alike, and not a degree earlier."""
    hysteresis = radians(20.0)
    away = 1.0 if past == 0.0 else -1.0
    for degrees, expected in ((19.0, side), (21.0, -side)):
        bearing = wrap_angle(side * (past + away * radians(degrees)))
        assert laws.update_side(side, bearing, hysteresis) == expected
    assert laws.update_side(side, -side * 1.0, hysteresis) == side


@given(ANGLES)
def test_without_hysteresis_the_side_is_the_one_behind(bearing: float) -> None:
    if 1e-9 < abs(bearing) < pi - 1e-9:
        for side in (-1, 0, 1):
            kept = laws.update_side(side, bearing, 0.0)
            assert kept == laws.side_behind(bearing)


def test_turning_is_proportional_or_saturated() -> None:
    """Eqs. (4) and (6): the second reaches k whatever the error."""
    assert laws.proportional_rate(0.5, 0.2) == pytest.approx(0.1)
    assert laws.proportional_rate(-0.5, 0.2) == pytest.approx(-0.1)
    for error in (1e-12, 0.5, 3.0):
        assert laws.saturated_rate(error, 0.2) == 0.2
        assert laws.saturated_rate(-error, 0.2) == -0.2
    assert laws.saturated_rate(0.0, 0.2) == 0.0
    for error in (1.0, -1.0):  # where both laws meet
        assert laws.saturated_rate(error, 0.2) == laws.proportional_rate(
            error, 0.2
        )


def test_evasion_is_latched_between_both_distances() -> None:
    distances = (0.81, 0.8, 0.79, 1.0, 1.19, 1.2, 1.0, 0.7)
    evading, seen = False, []
    for distance in distances:
        evading = laws.is_evading(evading, distance, 0.8, 1.2)
        seen.append(evading)
    expected = [False, False, True, True, True, False, False, True]
    assert seen == expected
    assert laws.is_evading(True, 1e9, 0.8, inf)


@pytest.mark.parametrize("step", [0.01, -0.01])
def test_desired_heading_is_continuous_where_the_bearing_wraps(
    step: float,
) -> None:
    near = copysign(pi - 1e-3, step)
    side = laws.side_behind(near)
    after = wrap_angle(near + step)
    side = laws.update_side(side, after, radians(20.0))
    change = laws.evasion_heading(after, side, pi / 2) - laws.evasion_heading(
        near, laws.side_behind(near), pi / 2
    )
    assert wrap_angle(change) == pytest.approx(step)
