"""Test games without bodies: the same duel from every door, and its laws."""

import json
from dataclasses import replace
from math import pi, sin
from typing import Any

import numpy as np
import pytest

import doors
from floor_duels import STEP
from stepaside.arena import Disc, Room, RoomRecipe, generate_room
from stepaside.core.poses import Pose
from stepaside.games import GameSettings, Outcome, duel, run_game
from stepaside.games.game_settings import read_game
from stepaside.strategies import Pursuit
from tools.documents.store import ROOT

LEVELS = ("steps", "unicycle")


def test_levels_differ_by_the_delay_of_a_decision() -> None:
    start = {"distance": 1.0, "pursuer_offset": -0.3, "evader_offset": 0.2}
    steps, unicycle = (
        run_game(duel(level=level, duration=300 * STEP, start=start))
        for level in LEVELS
    )
    expected = 4.0 * 0.1 * sin(pi / 4.0) / (0.2 * pi / 2.0)
    for run in (steps, unicycle):
        assert run.distance[-1] == pytest.approx(expected, rel=1e-3)
        assert run.theory is not None
        assert run.theory[1] == pytest.approx(expected)
        assert 0.0 < (run.summary.converged_at_s or 0.0) < 0.5 * run.duration
    assert 0.0 < unicycle.distance.min() - steps.distance.min() < 0.03


def room_of_3() -> Room:
    return generate_room(RoomRecipe(discs=3), 3)


def in_room(level: str, **changes: Any) -> GameSettings:
    """Return a game file of two in a room; the evader moves aside."""
    room = room_of_3()
    assert room.starts is not None
    players: list[dict[str, Any]] = [
        {"name": role, "role": role, "start": list(start)}
        for role, start in zip(("pursuer", "evader"), room.starts, strict=True)
    ]
    players[1]["evasion"] = {"safety_radius": 10.0}
    entries = {"level": level, "players": players, **changes}
    return replace(read_game(entries, "game"), room=room)


@pytest.mark.parametrize("level", LEVELS)
def test_a_wall_ends_a_game(level: str) -> None:
    run = run_game(in_room(level))
    assert run.outcome is Outcome.TOUCHED
    assert run.summary.touched == ["evader"]
    clear = room_of_3().clearance(run.evader.unicycle[:, :2])
    assert 0.2 - 0.04 < clear.min() == clear[-1] < 0.2  # in one step


@pytest.mark.parametrize("level", LEVELS)
def test_capture_ends_a_game_from_every_door(level: str) -> None:
    still = {"strategy": "stand"}
    players = [
        {"name": "red", "role": "pursuer", "start": [0.0, 0.0, 0.0]},
        {"name": "blue", "role": "evader", "start": [1.0, 0.0, 0.0]} | still,
    ]
    for capture in (0.35, 0.2):
        entries = {"level": level, "players": players, "capture": capture}
        run = run_game(read_game(entries, "game"))
        assert run.outcome is Outcome.CAPTURED
        assert run.message.startswith("red captured blue by")
        reached = 1.0 - capture
        red = run.tracks["red"].unicycle[-1]
        assert reached <= red[0] < reached + 0.04


@pytest.mark.parametrize("radius", [0.2, 0.05])
def test_a_pursuer_goes_around_a_disc(radius: float) -> None:
    """By its own radius, whatever its strategy keeps."""
    room = Room(obstacles=(Disc(0.0, 0.0, 0.3),))
    settings = duel(level="steps", evader="stand")
    starts = Pose(-1.0, 0.1, 0.0), Pose(1.0, 0.0, 0.0)
    settings = replace(settings, room=replace(room, starts=starts))
    own = {"pursuer": Pursuit(body_radius=radius)}
    run = run_game(settings, strategies=own)
    assert run.outcome is Outcome.CAPTURED
    nearest = room.clearance(run.pursuer.unicycle[:, :2]).min()
    assert 0.2 - 1e-9 <= nearest < 0.4


STORED = json.loads((ROOT / "docs/results/doors.json").read_text())["rows"]


@pytest.mark.parametrize("door", doors.DOORS)
@pytest.mark.parametrize("level", LEVELS)
def test_a_duel_is_the_documented_one_from_every_door(
    level: str, door: str
) -> None:
    for row in STORED:
        if (row["level"], row["door"]) != (level, door):
            continue
        found = doors.DOORS[door](level, room=row["room"])
        assert found is not None
        stored = {name: row[name] for name in found}
        assert found == pytest.approx(stored, rel=1e-5, abs=1e-9)


@pytest.mark.parametrize("room", [False, True])
@pytest.mark.parametrize("level", [*LEVELS, "physics"])
def test_documented_doors_of_a_level_agree(level: str, room: bool) -> None:
    rows = [r for r in STORED if (r["level"], r["room"]) == (level, room)]
    assert len(rows) == (4 if level == "physics" else 5)
    assert_equal(rows)


def assert_equal(rows: list[dict[str, Any]]) -> None:
    """Assert that games ended alike."""
    assert len({row["outcome"] for row in rows}) == 1
    for name in ("time_s", "distance_m"):
        assert np.ptp([row[name] for row in rows]) < 1e-5


@pytest.mark.parametrize("room", [False, True])
def test_doors_of_physics_agree(
    room: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(doors, "DURATION", 8.0)
    names = ("Python", "game file", "environment")
    rows = [doors.DOORS[name]("physics", room=room) for name in names]
    assert_equal([row for row in rows if row is not None])
