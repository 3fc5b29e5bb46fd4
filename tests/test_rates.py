"""Test the rates of the line of sight."""

from math import pi, sin

import pytest

from stepaside.strategies.rates import Rates, SightRates

STEP = 0.5


def test_nothing_is_known_of_the_first_sightings() -> None:
    rates = SightRates(STEP)
    for time in (0.0, 0.0, 0.1, 0.3):
        assert rates.note(time, 0.3, 1.0) == Rates(None, None)


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


def test_after_a_gap_nothing_is_known() -> None:
    rates = SightRates(STEP)
    for time in (0.0, 0.5, 1.0):
        rates.note(time, time, 1.0)
    assert rates.note(9.0, 0.0, 5.0) == Rates(None, None)


def test_few_sightings_are_kept_for_however_long() -> None:
    rates = SightRates(STEP)
    for tick in range(5000):
        rates.note(0.004 * tick, 0.0, 1.0)
    assert len(rates._seen) <= 20
