"""Test the search for the pursuer that captures an evader soonest."""

from pathlib import Path

import pytest

from stepaside.arena import RoomRecipe
from stepaside.strategies.strategy_game import StepGame
from stepaside.studies import pursuer_search
from stepaside.studies.pursuer_search import (
    search_pursuer,
    searched_pursuer,
)
from stepaside.studies.tournament_record import play_record
from stepaside.studies.tournament_settings import TournamentSettings

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
