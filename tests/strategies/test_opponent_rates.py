"""Test the rates of the line of sight."""

from math import pi, sin

import pytest

from stepaside.strategies.opponent_rates import (
    FloorVelocity,
    SightRateEstimate,
    SightRates,
)

STEP = 0.5


def test_rates_are_unknown_for_the_first_sightings() -> None:
    rates = SightRates(STEP)
    for time in (0.0, 0.0, 0.1, 0.3):
        assert rates.note(time, 0.3, 1.0) == SightRateEstimate(None, None)


@pytest.mark.parametrize("every", [0.004, 0.1, 0.5])
def test_a_steady_motion_gives_its_rates(every: float) -> None:
    """Closing is positive, turning to the left too."""
    rates, time = SightRates(STEP), 0.0
    while time < 3.0:
        found = rates.note(time, 0.3 * time, 2.0 - 0.2 * time)
        time += every
    assert tuple(found) == pytest.approx((0.3, 0.2))


def test_the_line_of_sight_wraps() -> None:
    rates = SightRates(STEP)
    rates.note(0.0, pi - 0.1, 1.0)
    found = rates.note(1.0, -pi + 0.1, 1.0)
    assert found.bearing_rate == pytest.approx(0.2)


def test_the_sway_of_a_gait_cycle_drops_out() -> None:
    """Sighted at the end of every step, on the left and on the right."""
    rates, worst = SightRates(STEP), 0.0
    for step in range(12):
        sway = 0.02 * sin(pi * (step + 0.5))
        found = rates.note(step * STEP, sway, 1.0 + sway)
        if step >= 2:
            worst = max(worst, abs(found.bearing_rate or 0.0))
            worst = max(worst, abs(found.closing_speed or 0.0))
    assert worst < 1e-12


def test_rates_are_unknown_after_a_gap() -> None:
    rates = SightRates(STEP)
    for time in (0.0, 0.5, 1.0):
        rates.note(time, time, 1.0)
    assert rates.note(9.0, 0.0, 5.0) == SightRateEstimate(None, None)


@pytest.mark.parametrize("every", [0.004, 0.1, STEP])
def test_a_straight_walk_has_a_constant_velocity(
    every: float,
) -> None:
    drift, time = FloorVelocity(STEP), 0.0
    while time < 3.0:
        found = drift.note(time, 1.0 - 0.8 * time, 0.3 * time)
        assert (found is None) == (time <= 0.75 * STEP)
        if found is not None:
            assert found == pytest.approx((-0.8, 0.3))
        time += every


def test_one_bad_sighting_counts_less_than_a_difference_would() -> None:
    drift = FloorVelocity(STEP)
    for i in range(30):
        found = drift.note(0.1 * i, 0.0, 0.1 if i == 29 else 0.0)
    assert found is not None and found[0] == pytest.approx(0.0)
    assert 0.0 < found[1] < 0.1 / (3.25 * STEP) * 1.5


def test_a_velocity_needs_sightings_of_late() -> None:
    drift = FloorVelocity(STEP)
    for i in range(20):
        drift.note(0.1 * i, 0.1 * i, 0.0)
    assert drift.note(60.0, 9.0, 0.0) is None
    assert drift.note(60.0 + STEP, 9.0, 0.4 * STEP) == pytest.approx(
        (0.0, 0.4)
    )
