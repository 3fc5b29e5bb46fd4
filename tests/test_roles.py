"""Test the rules from line of sight to desired direction (Sec. II)."""

from math import copysign, cos, pi, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.errors import ConfigurationError
from stepaside.planning import Direction
from stepaside.poses import wrap_angle
from stepaside.strategies.roles import Evasion, Pursuit, Walk


def test_pursuer_heads_for_the_other_wherever_it_is() -> None:
    role = Pursuit()
    assert role.desired_heading(0.4) == 0.4
    assert role.desired_heading(-0.4) == -0.4
    assert role.direction is Direction.FORWARD
    assert role.is_triggered(0.0) and role.is_triggered(100.0)


def test_a_walk_heads_where_it_was_told_whatever_is_seen() -> None:
    role = Walk(bearing=-0.3)
    assert role.desired_heading(1.0) == role.desired_heading(-1.0) == -0.3
    assert role.is_triggered(0.0) and role.is_triggered(100.0)
    assert role.direction is Direction.FORWARD
    assert Walk().desired_heading(1.0) == 0.0


def test_players_turn_by_8_unless_told_otherwise() -> None:
    """Eq. (6), bang-bang, is for the figure that compares both."""
    assert not any(r.saturated for r in (Pursuit(), Evasion(), Walk()))


def test_evader_of_the_paper_moves_aside_backwards_from_0_8_m() -> None:
    """Sec. IV: the safety area has a radius of 0.8 m and has no end."""
    role = Evasion()
    assert role.direction is Direction.BACKWARD
    assert not role.is_triggered(0.801)
    assert role.is_triggered(0.799) and role.is_triggered(1e6)
    assert role.side_hysteresis == pytest.approx(radians(20.0))


@given(st.floats(-pi, pi))
def test_moving_aside_is_across_the_line_of_sight_and_behind(
    bearing: float,
) -> None:
    """Sec. II-B: of the two normals take the one behind the robot."""
    heading = Evasion().desired_heading(bearing)
    motion = (-cos(heading), -sin(heading))
    along = motion[0] * cos(bearing) + motion[1] * sin(bearing)
    assert along == pytest.approx(0.0, abs=1e-12)
    assert motion[0] <= 1e-12


@given(st.floats(-pi, pi))
def test_moving_back_leads_away_from_the_other(bearing: float) -> None:
    """Alpha = 0 taken literally in (5) would walk into the pursuer."""
    heading = Evasion(angle=0.0).desired_heading(bearing)
    away = -cos(heading) * cos(bearing) - sin(heading) * sin(bearing)
    assert away == pytest.approx(-1.0)


@given(st.floats(0.01, 3.1))
def test_rule_is_the_same_on_both_sides(bearing: float) -> None:
    left = Evasion(angle=1.0).desired_heading(bearing)
    right = Evasion(angle=1.0).desired_heading(-bearing)
    assert left == pytest.approx(-right)


def test_noise_about_straight_ahead_does_not_flip_the_side() -> None:
    role = Evasion()
    first = role.desired_heading(0.02)
    assert role.desired_heading(-0.02) == pytest.approx(first, abs=0.05)
    flipped = role.desired_heading(radians(-40.0))
    assert flipped == pytest.approx(radians(50.0))


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("past", [0.0, pi])
def test_side_changes_beyond_the_hysteresis_at_both_ends(
    side: float, past: float
) -> None:
    """At psi = 0 and at psi = pi alike, and not a degree earlier."""
    inside, beyond = radians(19.0), radians(21.0)
    role = Evasion(side_hysteresis=radians(20.0))
    role.desired_heading(side * 1.0)
    away = -1.0 if past == 0.0 else 1.0
    role.desired_heading(wrap_angle(side * (past + away * inside)))
    assert role.side == side
    role.desired_heading(wrap_angle(side * (past + away * beyond)))
    assert role.side == -side


@pytest.mark.parametrize("step", [0.01, -0.01])
def test_desired_heading_is_continuous_where_the_bearing_wraps(
    step: float,
) -> None:
    role = Evasion()
    before = role.desired_heading(copysign(pi - 1e-3, step))
    after = role.desired_heading(wrap_angle(copysign(pi - 1e-3, step) + step))
    assert wrap_angle(after - before) == pytest.approx(step)


def test_evasion_latches_until_the_release_distance() -> None:
    role = Evasion(safety_radius=0.8, release_distance=1.2)
    distances = (1.0, 0.79, 1.0, 1.19, 1.21, 1.0, 0.7)
    expected = (False, True, True, True, False, False, True)
    assert tuple(map(role.is_triggered, distances)) == expected


def test_side_is_chosen_anew_after_a_release() -> None:
    """Kept, it would send the evader to the wrong side of a new pursuer."""
    role = Evasion(safety_radius=0.8, release_distance=1.2)
    role.is_triggered(0.7)
    role.desired_heading(radians(10.0))
    assert role.side == 1.0
    role.is_triggered(1.1)
    assert role.side == 1.0  # not before it ends
    role.is_triggered(1.3)
    assert role.side is None
    role.is_triggered(0.7)
    assert role.desired_heading(radians(-10.0)) == pytest.approx(radians(80.0))


@given(st.floats(-pi, pi), st.floats(-pi, pi), st.floats(0.0, pi))
def test_desired_heading_is_an_angle_within_half_a_turn(
    first: float, then: float, angle: float
) -> None:
    """Also when the latched side is not that of the bearing."""
    role = Evasion(angle=angle)
    role.desired_heading(first)
    assert abs(role.desired_heading(then)) <= pi


@pytest.mark.parametrize("angle", [0.0, pi])
def test_extreme_strategies_are_allowed(angle: float) -> None:
    assert Evasion(angle=angle, side_hysteresis=0.0).angle == angle


@pytest.mark.parametrize(
    "bad",
    [
        {"angle": -0.1},
        {"angle": float("nan")},
        {"safety_radius": 0.0},
        {"release_distance": 0.5},
        {"release_distance": 0.8},
        {"side_hysteresis": -0.1},
        {"side_hysteresis": 3.2},
        {"angle": 3.2},
    ],
)
def test_impossible_evasion_is_refused(bad: dict[str, float]) -> None:
    with pytest.raises(ConfigurationError, match=next(iter(bad))):
        Evasion(**bad)  # type: ignore[arg-type]
