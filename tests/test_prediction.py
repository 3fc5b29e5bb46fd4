"""Test the line of sight of the time for which a plan is made."""

from math import pi

import pytest

from stepaside.control.prediction import LineOfSightPrediction
from stepaside.poses import wrap_angle

LEAD = 0.3  # [s]


def watch(
    lead: LineOfSightPrediction, rate: float, *, sightings: int = 60
) -> tuple[float, float]:
    """Show a line of sight that turns; last time and what is foreseen."""
    ahead = 0.0
    for i in range(sightings):
        ahead = lead.ahead(0.5 * i, wrap_angle(rate * 0.5 * i))
    return 0.5 * (sightings - 1), ahead


@pytest.mark.parametrize("rate", [0.3, -0.3])
def test_a_steady_rotation_is_foreseen_exactly(rate: float) -> None:
    """Ahead of what is seen, in the sense in which it turns."""
    time, ahead = watch(LineOfSightPrediction(LEAD, 0.3), rate)
    off = wrap_angle(ahead - rate * (time + LEAD))
    assert off == pytest.approx(0.0, abs=1e-6)


def test_a_line_at_rest_stays_where_it_is() -> None:
    lead = LineOfSightPrediction(LEAD, 0.3)
    assert [lead.ahead(t, 0.7) for t in (0.0, 0.5, 1.0)] == [0.7] * 3


def test_the_first_sighting_has_no_rate() -> None:
    assert LineOfSightPrediction(LEAD, 1.0).ahead(3.0, -0.4) == -0.4


def test_the_newest_rate_enters_with_its_weight() -> None:
    lead = LineOfSightPrediction(LEAD, 0.25)
    lead.ahead(0.0, 0.0)
    assert lead.ahead(0.5, 0.1) == pytest.approx(0.1 + 0.25 * 0.2 * LEAD)
    rate = 0.05 + 0.25 * (-0.4 - 0.05)
    assert lead.ahead(1.0, -0.1) == pytest.approx(-0.1 + rate * LEAD)


def test_a_step_over_the_half_turn_is_no_rotation() -> None:
    lead = LineOfSightPrediction(LEAD, 1.0)
    lead.ahead(0.0, pi - 0.01)
    ahead = lead.ahead(0.5, -pi + 0.01)
    assert ahead == pytest.approx(-pi + 0.01 + 0.04 * LEAD)


@pytest.mark.parametrize(("gap", "kept"), [(1.9, True), (2.1, False)])
def test_after_a_gap_the_rate_is_forgotten(gap: float, kept: bool) -> None:
    lead = LineOfSightPrediction(LEAD, 0.5)
    time, _ = watch(lead, 0.3)
    direction = wrap_angle(0.3 * (time + gap))
    foreseen = wrap_angle(lead.ahead(time + gap, direction) - direction)
    expected = 0.3 * LEAD if kept else 0.0
    assert foreseen == pytest.approx(expected, abs=1e-6)
    # What follows the gap is measured from its end.
    later = lead.ahead(time + gap + 0.5, direction + 0.15)
    rate = 0.3 if kept else 0.5 * 0.3
    assert wrap_angle(later - direction - 0.15) == pytest.approx(
        rate * LEAD, abs=1e-6
    )


def test_the_same_sighting_again_changes_nothing() -> None:
    """Between two sightings a plan may be made from the old one."""
    lead = LineOfSightPrediction(LEAD, 0.5)
    lead.ahead(0.0, 0.0)
    first = lead.ahead(0.5, 0.1)
    assert lead.ahead(0.5, 0.1) == first
    assert lead.ahead(0.4, 0.1) == first
