"""Test the search for the pursuer that captures an evader soonest."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.arena import RoomRecipe
from stepaside.cli.main import main
from stepaside.strategies import ParametricPursuit
from stepaside.strategies.strategy_game import StepGame
from stepaside.studies import pursuer_search
from stepaside.studies.pursuer_search import (
    pursuer_at,
    search_pursuer,
    searched_pursuer,
)
from stepaside.studies.tournament_record import play_record
from stepaside.studies.tournament_settings import TournamentSettings
from stepaside.studies.tournament_strategies import (
    search_seed_of,
    speed_ratio_of,
)

SETTINGS = TournamentSettings(
    room=RoomRecipe(None, None), game=StepGame(duration=60.0)
)


@pytest.fixture(autouse=True)
def few(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Try few pursuers, and keep them in a cache of the test."""
    monkeypatch.setattr(pursuer_search, "CANDIDATES", 6)
    monkeypatch.setattr(pursuer_search, "REFINED", 6)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    searched_pursuer.cache_clear()


def test_search_finds_a_pursuer_that_captures_where_the_papers_does_not() -> (
    None
):
    survived = play_record(SETTINGS, ("aside", "pure"), 5)
    captured = play_record(SETTINGS, ("aside", "searched-1"), 5)
    assert survived["outcome"] == "survived"
    assert survived["searched"] is None
    assert captured["outcome"] == "captured"
    assert captured["searched"].startswith("gain x")


def test_search_depends_on_its_seed_only() -> None:
    first, again = (
        search_pursuer(SETTINGS, "aside", 1.0, 1) for _ in range(2)
    )
    assert first == again
    assert search_pursuer(SETTINGS, "aside", 1.0, 2) != first


def test_a_found_pursuer_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    found = searched_pursuer(SETTINGS, "aside", 1.0, 1)
    searched_pursuer.cache_clear()
    monkeypatch.setattr(
        pursuer_search, "search_pursuer", lambda *_: pytest.fail("searched")
    )
    assert searched_pursuer(SETTINGS, "aside", 1.0, 1) == found


def test_names_of_searched_pursuers() -> None:
    assert search_seed_of("searched-12") == 12
    assert search_seed_of("searched-12-v1.1") == 12
    assert speed_ratio_of("searched-12-v1.1") == 1.1
    assert search_seed_of("searched-") is None
    assert search_seed_of("pure") is None


def test_the_ranges_hold_the_paper_s_pursuer_and_the_sharp_one() -> None:
    low, high = pursuer_at(np.zeros(4)), pursuer_at(np.ones(4))
    assert low.gain_ratio < 1.0 < 12.5 <= high.gain_ratio
    assert low.pull < 0.0 < 1.0 < high.pull
    assert low.sway == 0.0
    assert isinstance(low, ParametricPursuit)


def test_no_searched_pursuer_plays_in_physics() -> None:
    words = ["tournament", "--level", "physics", "--evader", "aside"]
    result = CliRunner().invoke(main, [*words, "--pursuer", "searched-1"])
    assert result.exit_code == 2
    assert "searched-SEED" in result.output
