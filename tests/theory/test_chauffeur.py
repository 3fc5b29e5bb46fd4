"""Test the chauffeur's game: closed forms, grids and simulated games."""

from dataclasses import replace
from math import asin, cos, pi, sqrt

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.chauffeur import (
    ChauffeurGame,
    ChauffeurTable,
    SpeedEllipse,
    solve_chauffeur,
)
from stepaside.theory.chauffeur.chauffeur_checks import (
    check_chauffeur_barrier,
    play_chauffeur,
)
from stepaside.theory.chauffeur.chauffeur_game import (
    chauffeur_barrier,
    guaranteed_distance,
)
from stepaside.theory.chauffeur.sampled_value import decide, standing_table

RATIO = 0.643
CELLS = 60


def game_of(ratio: float, radius: float = 1.0) -> ChauffeurGame:
    return ChauffeurGame(1.0, radius, SpeedEllipse.disc(ratio))


@pytest.fixture(scope="module")
def table() -> ChauffeurTable:
    return solve_chauffeur(game_of(RATIO), CELLS)


def test_closed_form_is_continuous_and_has_its_limits() -> None:
    """gamma^2 / 2 for slow evaders; pi / 2 - 1 at the first regime's end."""
    assert guaranteed_distance(0.01) == pytest.approx(0.5e-4, rel=1e-3)
    edge = 0.8975
    low, high = (
        guaranteed_distance(edge - 2e-4),
        guaranteed_distance(edge + 2e-4),
    )
    assert abs(high - low) < 1e-3
    assert guaranteed_distance(1.0) == pytest.approx(0.563, abs=1e-3)


def test_straight_run_against_a_full_turn_grazes_the_capture_circle() -> None:
    """Play barrier points forwards, in coordinates of the floor."""
    capture = 0.15
    line = chauffeur_barrier(game_of(RATIO), capture, 7)
    side = np.arccos(RATIO)
    ends = np.linspace(0.0, _closing_time(capture), 7)
    for (ahead, left), t in zip(line, ends, strict=True):
        # The car turns left; the run is normal to the circle of capture.
        run = side + t
        times = np.linspace(0.0, t + 0.3, 4001)
        x = ahead + RATIO * times * cos(run) - np.sin(times)
        y = left + RATIO * times * np.sin(run) - (1.0 - np.cos(times))
        distances = np.hypot(x, y)
        assert distances.min() == pytest.approx(capture, abs=1e-4)
        assert times[distances.argmin()] == pytest.approx(t, abs=0.02)


def _closing_time(capture: float) -> float:
    """Time at which the left half of the barrier meets the axis."""
    t = np.linspace(0.0, asin(RATIO), 20_000)
    s = np.arccos(RATIO)
    side = (capture - RATIO * t) * np.sin(s + t) + 1.0 - np.cos(t)
    return float(t[np.argmax(side <= 0.0)])


@pytest.mark.parametrize("ratio", [0.36, 0.8, 0.95])
def test_grid_agrees_with_the_closed_form(ratio: float) -> None:
    """In both regimes; the solver knows the formula only as a cap."""
    found = solve_chauffeur(game_of(ratio), CELLS).guaranteed
    assert found == pytest.approx(guaranteed_distance(ratio), rel=0.006)


def test_longer_periods_guarantee_less(table: ChauffeurTable) -> None:
    longer = solve_chauffeur(game_of(RATIO), CELLS, period=0.9).guaranteed
    assert table.period < 0.9
    assert longer < table.guaranteed
    assert table.guaranteed == pytest.approx(
        guaranteed_distance(RATIO), rel=0.006
    )


def test_barrier_of_the_table_is_within_a_third_of_a_cell(
    table: ChauffeurTable,
) -> None:
    for capture in (0.1, 0.15):
        found = check_chauffeur_barrier(table, capture)
        assert np.abs(found.errors).max() < 0.33 * found.spacing


def test_value_is_no_larger_than_the_guarantee_and_the_distance(
    table: ChauffeurTable,
) -> None:
    x, y = table.plane.axes()
    assert (table.values <= np.hypot(x[:, None], y) + 1e-12).all()
    assert table.values.max() <= 1.02 * table.guaranteed
    assert table.value(50.0, 20.0) == table.guaranteed


def test_simulated_evader_keeps_what_the_table_guarantees(
    table: ChauffeurTable,
) -> None:
    """Against the answer of the table, and a car that reacts faster."""
    starts = np.random.default_rng(5).uniform(
        [-0.4, -0.9], [1.2, 0.9], (60, 2)
    )
    expected = table.value(*starts.T)
    for pursuer in ("optimal", "direct"):
        closest = play_chauffeur(table, starts, duration=6.0, pursuer=pursuer)
        assert (closest - expected).min() > -0.02 * table.guaranteed


def test_lengths_scale_with_the_turning_radius(table: ChauffeurTable) -> None:
    wide = solve_chauffeur(
        ChauffeurGame(1.4, 2.5, SpeedEllipse.disc(1.4 * RATIO)), CELLS
    )
    np.testing.assert_allclose(wide.values, table.values, atol=1e-9)
    assert wide.guaranteed == pytest.approx(2.5 * table.guaranteed)


def test_ellipse_lies_between_its_discs() -> None:
    ellipse = SpeedEllipse(0.6, 0.6, 0.4)
    found = [
        solve_chauffeur(ChauffeurGame(1.0, 1.0, each), 24).guaranteed
        for each in (
            SpeedEllipse.disc(ellipse.smallest),
            ellipse,
            SpeedEllipse.disc(ellipse.largest),
        )
    ]
    assert found[0] < found[1] < found[2]


def test_boundary_of_a_set_has_its_three_speeds() -> None:
    rows = SpeedEllipse(0.3, 0.2, 0.1).boundary(48)
    assert rows[:, 0].max() == pytest.approx(0.2)
    assert rows[:, 0].min() == pytest.approx(-0.3)
    assert rows[:, 1].max() == pytest.approx(0.1)
    assert (rows[-1] == 0.0).all()


def test_standing_never_helps_and_long_standing_is_contact(
    table: ChauffeurTable,
) -> None:
    values = [
        standing_table(table, count * table.period).values
        for count in (0, 1, 2, 4)
    ]
    for before, after in zip(values, values[1:], strict=False):
        assert (after <= before).all() and after.mean() < before.mean()
    late = standing_table(table, 0.8)
    assert float(late.value(0.5, 0.0)) < 0.02 < float(table.value(0.5, 0.0))


def test_evader_straight_ahead_leaves_the_axis(table: ChauffeurTable) -> None:
    velocity, _ = decide(table, np.array([0.45]), np.array([0.0]))
    assert abs(velocity[0, 1]) > 0.5 * RATIO
    assert np.hypot(*velocity[0]) == pytest.approx(RATIO)


@pytest.mark.parametrize("speed", [1.0, 1.4])
def test_evader_that_is_as_fast_is_refused(speed: float) -> None:
    with pytest.raises(PlanError, match="evader_speed must be < pursuer"):
        game_of(speed)


def test_barrier_without_a_closed_form_is_refused() -> None:
    with pytest.raises(PlanError, match="barrier is known for one speed"):
        chauffeur_barrier(game_of(0.95), 0.2)
    ellipse = replace(game_of(0.5), velocities=SpeedEllipse(0.5, 0.5, 0.4))
    with pytest.raises(PlanError, match="barrier is known for one speed"):
        chauffeur_barrier(ellipse, 0.05)
    with pytest.raises(PlanError, match="capture must lie in"):
        chauffeur_barrier(game_of(0.5), 0.2)
    assert sqrt(1.0 - 0.25) + 0.5 * pi / 6 - 1.0 == pytest.approx(
        guaranteed_distance(0.5)
    )
