"""Test duels in physics: circle, symmetry and endings."""

import numpy as np
import pytest

from stepaside.games import Outcome, duel, run_game
from stepaside.games.game_settings import StartSettings
from stepaside.strategies import Evasion


@pytest.mark.slow
def test_evader_stands_until_its_safety_area_is_entered() -> None:
    start = StartSettings(1.2, 0.0, 0.0)
    result = run_game(duel(duration=12.0, start=start))
    triggered = result.summary.triggered_at_s
    assert triggered is not None
    at = int(np.searchsorted(result.times, triggered))
    assert result.distance[at] == pytest.approx(0.8, abs=0.01)
    evader = result.evader.com
    assert np.abs(evader[: at - 1, :2] - evader[0, :2]).max() < 0.005


@pytest.mark.slow
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
