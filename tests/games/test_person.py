"""Test a person as pursuer."""

import pytest

from stepaside.games.game_settings import GameSettings, StartSettings, duel
from stepaside.games.recorded_game import run_game
from stepaside.sim.person_settings import PersonSettings

pytestmark = pytest.mark.usefixtures("blank_figures")

START = StartSettings(distance=1.5, pursuer_offset=0.0, evader_offset=0.0)


def duel_with(person: PersonSettings, duration: float) -> GameSettings:
    return duel(
        duration=duration,
        start=START,
        pursuer={"body": "person"},
        person=person,
    )


def test_a_person_that_passes_outside_triggers_nothing() -> None:
    person = PersonSettings("straight", 0.5, miss=1.3)
    result = run_game(duel_with(person, 6.0))
    summary = result.summary
    assert summary.triggered_at_s is None
    assert summary.planning is not None and summary.planning.replans == 0
    assert result.outcome.value == "completed"
    assert summary.theory is not None
    theory = summary.theory.min_distance_m
    assert summary.min_distance_m == pytest.approx(theory, abs=0.05)


@pytest.mark.slow
def test_a_slow_person_is_evaded_close_to_theory() -> None:
    """The robot loses the person's path until its first step lands."""
    result = run_game(duel_with(PersonSettings("steer", 0.073, 0.146), 40.0))
    summary = result.summary
    assert result.outcome.value == "completed"
    assert summary.triggered_at_distance_m == pytest.approx(0.8, abs=0.02)
    assert summary.triggered_at_s is not None
    assert result.evader.landings is not None
    late = result.evader.landings[0, 0] - summary.triggered_at_s
    assert 1.0 < late < 1.5
    late -= result.settings.gait.start_support  # after which theory moves
    assert summary.theory is not None
    theory = summary.theory.min_distance_m
    assert theory is not None
    assert summary.min_distance_m == pytest.approx(
        theory - 0.073 * late, abs=0.03
    )
