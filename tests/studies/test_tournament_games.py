"""Test games of tournaments, and their records."""

from dataclasses import replace
from math import cos, pi, sin
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.arena import RoomRecipe
from stepaside.core.convex import grown_hull_area
from stepaside.core.poses import wrap_angles
from stepaside.games.outcome import Outcome
from stepaside.games.run import GameRun
from stepaside.strategies import StepGame
from stepaside.strategies import table_cache as tables
from stepaside.studies import tournament as studied
from stepaside.studies.tournament import (
    ASIDE,
    PairingSettings,
    circle_distance,
    play_pairing,
    play_track,
)

SHORT = StepGame(duration=16.0)
SETTINGS = PairingSettings(room=RoomRecipe(discs=1), game=SHORT, seed=3)


@pytest.fixture(scope="module", autouse=True)
def coarse_table(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The bound is solved on few cells, and cached for this test only."""
    patch = pytest.MonkeyPatch()
    patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
    patch.setattr(studied, "CELLS", 16)
    tables.pursuit_bound.cache_clear()
    yield
    patch.undo()
    tables.pursuit_bound.cache_clear()


def test_a_record_is_what_the_game_was() -> None:
    record, track = play_pairing(SETTINGS), play_track(SETTINGS)
    room, _ = SETTINGS.arena()
    assert record["outcome"] == "completed"
    assert track.outcome is Outcome.COMPLETED
    assert record["closest_m"] == track.distances.min()
    assert record["survived_s"] == pytest.approx(16.0)
    assert record["clearance_m"] == pytest.approx(
        room.clearance(track.evader[:, :2]).min()
    )
    steps = record["walked_m"] / 0.04
    assert 39.5 < steps <= 40.0 + 1e-9  # arcs are longer than their chords


@pytest.mark.parametrize(
    ("level", "decisions"), [("steps", 1), ("unicycle", 8)]
)
def test_the_figures_of_a_game_are_those_of_its_track(
    level: str, decisions: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An evader that turns by 0.1 at each of 12 moves; who is 1 to 2 m off."""
    heading = pi - 0.65 + 0.1 * np.arange(13)
    ways = 0.03 * np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    places = np.cumsum([np.zeros(2), *ways[:-1]], axis=0)
    track = SimpleNamespace(
        outcome=Outcome.COMPLETED,
        distances=np.linspace(2.0, 1.0, 13),
        pursuer=np.full((13, 3), 5.0),
        evader=np.column_stack([places, wrap_angles(heading)]),
        clearances=np.linspace(0.1, 0.7, 13),
        bearings=np.where(np.arange(13) < 3, -2.6, 2.0),
        decision=1e-3,
        longest_decision=2e-3,
    )
    monkeypatch.setattr(studied, "play_track", lambda *_: track)
    asked: list[Any] = []

    def bound_of(*words: Any) -> int:
        asked.append(words)
        return 9

    monkeypatch.setattr(studied, "bound_of", bound_of)
    settings = replace(SETTINGS, level=level, evader=ASIDE)
    record = play_pairing(settings)
    seconds = 12.0 * SHORT.period / decisions
    assert record["survived_s"] == pytest.approx(seconds)
    assert record["closest_m"] == 1.0 and record["clearance_m"] == 0.1
    assert record["walked_m"] == pytest.approx(12 * 0.03)
    assert record["turning_rad_s"] == pytest.approx(12 * 0.1 / seconds)
    assert record["unseen"] == pytest.approx(3 / 13)
    assert record["floor_m2"] == pytest.approx(
        grown_hull_area(places, SHORT.body_radius)
    )
    assert record["bound_m"] == 9 and asked[0][2] is SHORT
    np.testing.assert_array_equal(asked[0][0], track.pursuer[0])
    np.testing.assert_array_equal(asked[0][1], track.evader[0])
    assert (record["decision_s"], record["longest_decision_s"]) == (1e-3, 2e-3)
    track.clearances = np.full(13, np.inf)
    assert play_pairing(settings)["clearance_m"] is None


def test_the_bound_is_that_of_the_start() -> None:
    """Facing each other the evader backs off for ever: it keeps it all."""
    x, y = 1.1 * cos(0.3), 1.1 * sin(0.3)
    found = studied.bound_of(
        np.array([0.0, 0.0, 0.3]), np.array([x, y, 0.3 + pi]), SHORT
    )
    assert found == pytest.approx(1.1, abs=0.02)
    away = studied.bound_of(
        np.array([0.0, 0.0, 0.3]), np.array([x, y, 0.3]), SHORT
    )
    assert away < 0.8  # it walks into the pursuer first


@pytest.mark.parametrize("ratio", [0.5, 1.7, 2.9])
def test_the_circle_of_a_gain_balances_both_players(ratio: float) -> None:
    """V cos a = v cos u, and both turn at the rate of the line of sight."""
    game = replace(SHORT, speed=0.3, gain=0.7)
    pursuer_gain = ratio * 0.7
    a = 0.5 * pi / (1.0 + pursuer_gain / 0.7)  # a + b = alpha, kp a = ke b
    distance = 2.0 * 0.3 * sin(a) / (pursuer_gain * a)
    found = circle_distance(game, f"pursuit(gain={ratio})")
    assert found == pytest.approx(distance)


def test_sharp_and_herding_capture_a_survivor_of_the_papers_pursuer() -> None:
    """In rooms of 3 m, look-ahead: each survives pure, few the others."""
    settings = replace(SETTINGS, room=RoomRecipe(), game=StepGame())
    survived = {
        pursuer: [
            play_track(replace(settings, pursuer=pursuer, seed=seed)).outcome
            for seed in range(1000, 1004)
        ].count(Outcome.COMPLETED)
        for pursuer in ("pursuit", "sharp", "herding")
    }
    assert survived["pursuit"] == 4
    assert survived["sharp"] == 0 and survived["herding"] <= 1


def test_humanoids_play_by_the_same_words() -> None:
    """A second of a duel: the figures are those that steps have as well."""
    in_steps = replace(SETTINGS, evader=ASIDE)
    game = StepGame(duration=1.0)
    settings = replace(in_steps, level="physics", game=game)
    found, steps = play_pairing(settings), play_pairing(in_steps)
    assert set(steps) - set(found) == {"clearance_m"}
    assert found["outcome"] == "completed" and found["touched"] == []
    assert found["survived_s"] == pytest.approx(1.0)
    assert found["bound_m"] == pytest.approx(steps["bound_m"], abs=0.02)
    pursuer, evader = settings.arena()[1]
    apart = np.hypot(pursuer.x - evader.x, pursuer.y - evader.y)
    assert found["closest_m"] == pytest.approx(apart, abs=0.05)
    for player in ("pursuer", "evader"):
        assert 0.1 < found[f"{player}_clearance_m"] < 1.5


def test_a_duel_that_is_stopped_is_no_game(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Games in this process, without workers, are interrupted."""
    ended: GameRun[Any, Any] = GameRun(
        "", None, Outcome.INTERRUPTED, "", 0.0, np.zeros(0), {}, None
    )
    played: list[int] = []

    def cut_short(settings: Any) -> Any:
        played.append(settings.seed)
        return ended

    monkeypatch.setattr(studied, "run_duel", cut_short)
    settings = replace(SETTINGS, level="physics", game=StepGame(duration=1.0))
    with pytest.raises(KeyboardInterrupt):
        play_pairing(settings)
    assert played == [3]
