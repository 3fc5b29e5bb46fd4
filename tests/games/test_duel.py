"""Test duels in physics: circle, symmetry and endings."""

from math import pi

import numpy as np
import pytest

from stepaside.games import Outcome, duel, run_game
from stepaside.games.game_settings import StartSettings
from stepaside.locomotion.control_settings import STABILISED
from stepaside.sim.body_settings import BODIES
from stepaside.strategies import Evasion


def test_evader_stands_until_its_safety_area_is_entered() -> None:
    start = StartSettings(1.2, 0.0, 0.0)
    result = run_game(duel(duration=12.0, start=start))
    triggered = result.summary.triggered_at_s
    assert triggered is not None
    at = int(np.searchsorted(result.times, triggered))
    assert result.distance[at] == pytest.approx(0.8, abs=0.01)
    evader = result.evader.com
    assert np.abs(evader[: at - 1, :2] - evader[0, :2]).max() < 0.005


def test_released_evader_comes_to_rest() -> None:
    """The pursuer first heads away, and the distance grows."""
    settings = duel(
        duration=14.0,
        start=StartSettings(0.7, 3.1, 0.0),
        evasion=Evasion(angle=0.0, release_distance=1.0),
    )
    result = run_game(settings)
    assert result.outcome is Outcome.COMPLETED
    times, landings = result.times, result.evader.landings
    assert landings is not None and len(landings) > 2
    assert landings[-1, 0] < times[-1] - 3.0
    rest = result.evader.com[times > times[-1] - 1.0, :2]
    assert np.ptp(rest, axis=0).max() < 0.005


def test_contact_that_is_forecast_leaves_no_circle() -> None:
    """An evader that faces away walks backward into its pursuer."""
    run = run_game(duel(start=StartSettings(1.0, 0.1, pi)))
    assert run.outcome is Outcome.CONTACT
    theory = run.summary.theory
    assert theory is not None and theory.expected == "contact"
    assert theory.distance_m is None and theory.radius_m is None


def test_a_robot_that_never_walked_has_no_zmp_margin() -> None:
    start = StartSettings(0.95, 0.3, -0.2)
    settings = duel(
        duration=0.1,
        start=start,
        body=BODIES["hardware"],
        control=STABILISED,
    )
    planning = run_game(settings).summary.planning
    assert planning is not None
    assert planning.min_zmp_margin_m is None and planning.replans == 0
    assert planning.max_com_velocity_jump_m_s == 0.0
    assert planning.median_us is planning.p99_us is None
