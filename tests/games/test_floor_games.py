"""Test games without bodies: the same duel from every door, and its laws."""

from dataclasses import replace
from math import pi, sin
from typing import Any

import numpy as np
import pytest

from stepaside.arena import Room, RoomRecipe, generate_room
from stepaside.games import Outcome, StepGame, StrategyTrack, play_strategies
from stepaside.games.game_settings import read_game
from stepaside.games.recorded_game import run_game
from stepaside.strategies import Evasion, Pursuit, Strategy
from stepaside.theory.unicycle import RelativeStart

START = RelativeStart(1.0, 0.3, -0.2).poses()
PARTS = {"steps": 1, "unicycle": 8}


def of_strategies(level: str, **changes: Any) -> StrategyTrack:
    rules = StepGame(decisions=PARTS[level], duration=40.0)
    room = changes.pop("room", Room())
    return play_strategies(
        Pursuit(), Evasion(), START, room=room, game=replace(rules, **changes)
    )


def test_levels_differ_by_the_delay_of_a_decision() -> None:
    steps, unicycle = (of_strategies(level, duration=120.0) for level in PARTS)
    expected = 4.0 * 0.1 * sin(pi / 4.0) / (0.2 * pi / 2.0)
    for track in (steps, unicycle):
        assert track.distances[-1] == pytest.approx(expected, rel=1e-3)
    assert 0.0 < unicycle.closest_distance - steps.closest_distance < 0.03


@pytest.mark.parametrize("level", PARTS)
def test_a_wall_ends_a_game_from_every_door(level: str) -> None:
    room = generate_room(RoomRecipe(discs=3), 3)
    assert room.starts is not None
    track = play_strategies(
        Pursuit(),
        Evasion(safety_radius=10.0),
        room.starts,
        room=room,
        game=StepGame(decisions=PARTS[level], solid_pursuer=True),
    )
    players: list[dict[str, Any]] = [
        {"name": role, "role": role, "start": list(start)}
        for role, start in zip(("pursuer", "evader"), room.starts, strict=True)
    ]
    players[1]["evasion"] = {"safety_radius": 10.0}
    settings = read_game({"level": level, "players": players}, "game")
    run = run_game(replace(settings, room=room))
    assert track.outcome is run.outcome is Outcome.TOUCHED
    assert run.summary.touched == ["evader"]
    for evader in (track.evader, run.tracks["evader"].unicycle):
        clear = room.clearance(evader[:, :2])
        assert 0.2 - 0.04 < clear.min() == clear[-1] < 0.2  # in one step
    ends = track.evader[-1], run.tracks["evader"].unicycle[-1]
    np.testing.assert_allclose(ends[0][:2], ends[1][:2], atol=1e-3)


@pytest.mark.parametrize("level", PARTS)
def test_capture_ends_a_game_from_every_door(level: str) -> None:
    still = {"strategy": "stand"}
    players = [
        {"name": "red", "role": "pursuer", "start": [0.0, 0.0, 0.0]},
        {"name": "blue", "role": "evader", "start": [1.0, 0.0, 0.0]} | still,
    ]
    run = run_game(read_game({"level": level, "players": players}, "game"))
    assert run.outcome is Outcome.CAPTURED
    assert run.message.startswith("red captured blue at")
    red = run.tracks["red"].unicycle[-1]
    assert 0.65 <= red[0] < 0.65 + 0.04


def test_a_pursuer_that_walls_stop_stays_clear_of_them() -> None:
    room = generate_room(RoomRecipe(discs=3), 3)
    assert room.starts is not None
    strategy: Strategy = Evasion()
    for solid in (True, False):
        track = play_strategies(
            Pursuit(), strategy, room.starts, room=room,
            game=StepGame(solid_pursuer=solid),
        )  # fmt: skip
        clear = room.clearance(track.pursuer[:, :2])
        assert not solid or clear.min() >= 0.2 - 1e-9
