"""Test games of tournaments, and their records."""

from math import pi, sin
from typing import Any

import pytest

from floor_duels import STEP
from stepaside.arena import RoomRecipe
from stepaside.games.game import Outcome
from stepaside.studies import tournament as studied
from stepaside.studies.tournament import (
    TOURNAMENT,
    PairingSettings,
    circle_distance,
    play_pairing,
    play_track,
)
from stepaside.theory.value import two_cars as tables

SHORT = TOURNAMENT.changed(duration=40 * STEP, seed=3)
SETTINGS = PairingSettings(SHORT, room=RoomRecipe(discs=1))


@pytest.fixture(scope="module", autouse=True)
def coarse_table() -> Any:
    """The bound is solved on few cells."""
    patch = pytest.MonkeyPatch()
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
    assert record["survived_s"] == pytest.approx(40 * STEP)
    assert record["clearance_m"] == pytest.approx(
        room.clearance(track.evader[:, :2]).min()
    )
    steps = record["walked_m"] / 0.04
    assert 39.5 < steps <= 40.0 + 1e-9  # arcs are longer than their chords


@pytest.mark.parametrize("ratio", [0.5, 1.7, 2.9])
def test_the_circle_of_a_gain_balances_both_players(ratio: float) -> None:
    """V cos a = v cos u, and both turn at the rate of the line of sight."""
    gait = {"speed": 0.3, "gain": 0.7}
    game = SHORT.changed(gait=gait, pursuer=f"pursuit(gain={ratio})")
    pursuer_gain = ratio * 0.7
    a = 0.5 * pi / (1.0 + pursuer_gain / 0.7)  # a + b = alpha, kp a = ke b
    distance = 2.0 * 0.3 * sin(a) / (pursuer_gain * a)
    assert circle_distance(game) == pytest.approx(distance)


def test_sharp_and_herding_capture_a_survivor_of_the_papers_pursuer() -> None:
    """In rooms of 3 m, look-ahead: each survives pure, few the others."""
    survived = {
        pursuer: [
            play_track(
                PairingSettings(TOURNAMENT.changed(pursuer=pursuer, seed=seed))
            ).outcome
            for seed in range(1000, 1004)
        ].count(Outcome.COMPLETED)
        for pursuer in ("pursuit", "sharp", "herding")
    }
    assert survived["pursuit"] == 4
    assert survived["sharp"] == 0 and survived["herding"] <= 1
