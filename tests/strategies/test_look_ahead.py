"""Test predictive evaders, alone and in step games."""

from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from stepaside.arena import Disc, ObstacleSet, Room, RoomRecipe, generate_room
from stepaside.core.compiled_cache import cache_folder
from stepaside.core.poses import Pose
from stepaside.games import Outcome, StepGame, play_strategies
from stepaside.strategies import (
    Evasion,
    Knowledge,
    Limits,
    LookAhead,
    Pursuit,
    Strategy,
)
from stepaside.theory.value import two_cars as tables

NAO = Limits(0.1, 0.2, 0.04, 0.4)
FACING = (Pose(0.0, 0.0, 0.6), Pose(1.0, 0.1, 3.3))
SHORT = StepGame(duration=30.0)
ASIDE = Evasion(safety_radius=100.0, side_hysteresis=0.0)


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def know(
    bearing: float, distance: float, pose: Pose, time: float
) -> Knowledge:
    return Knowledge(time, bearing, distance, NAO, pose_in_map=pose)


@pytest.mark.parametrize("seed", [1, 3])
def test_in_a_room_it_survives_where_moving_aside_touches(seed: int) -> None:
    room = generate_room(RoomRecipe(discs=3), seed)
    assert room.starts is not None
    game = StepGame(duration=60.0)

    def play(evader: Strategy) -> Outcome:
        assert room.starts is not None
        track = play_strategies(
            Pursuit(), evader, room.starts, room=room, game=game
        )
        if track.outcome is Outcome.COMPLETED:
            assert len(track.distances) == game.count + 1
            assert track.distances.min() > game.capture
            assert track.clearances.min() >= game.body_radius
        return track.outcome

    assert play(ASIDE) is Outcome.TOUCHED
    assert play(LookAhead()) is Outcome.COMPLETED


def test_with_its_back_in_a_corner_it_turns_before_it_walks() -> None:
    """Every sequence of steps from here is caught within 17."""
    room = generate_room(RoomRecipe(), 314)
    assert room.starts is not None
    track = play_strategies(
        Pursuit(),
        LookAhead(),
        room.starts,
        room=room,
        game=StepGame(duration=16.0),
    )
    assert track.outcome is Outcome.COMPLETED


def test_it_rather_stands_than_touches() -> None:
    """Its back is at a disc, and backward is the only way it has."""
    room = Room(obstacles=(Disc(0.5, 0.0, 0.29),))
    starts = (Pose(-1.0, 0.0, 0.0), Pose(0.0, 0.0, pi))
    track = play_strategies(
        Pursuit(), LookAhead(), starts, room=room, game=SHORT
    )
    assert track.clearances.min() >= 0.2
    alone = play_strategies(Pursuit(), ASIDE, starts, room=room, game=SHORT)
    assert alone.outcome is Outcome.TOUCHED


def test_it_knows_the_map_in_its_own_odometry() -> None:
    """Room and players turned and shifted together: the same decision."""
    mind, disc = LookAhead(), Disc(-0.5, 0.03, 0.2)
    here = know(0.1, 0.8, Pose(0.0, 0.0, 0.0), 0.0)
    frame = Pose(2.0, -1.0, 1.3)
    moved = Disc(*frame.compose(Pose(disc.x, disc.y, 0.0))[:2], disc.radius)
    there = replace(
        here,
        pose_in_map=frame,
        obstacles_in_map=ObstacleSet((moved,)),
    )
    one, _ = mind.decide(
        replace(here, obstacles_in_map=ObstacleSet((disc,))), mind.begin()
    )
    other, _ = mind.decide(there, mind.begin())
    assert other.heading == pytest.approx(one.heading, abs=1e-9)
    free, _ = mind.decide(
        replace(here, obstacles_in_map=ObstacleSet((Disc(9.0, 0.0, 0.1),))),
        mind.begin(),
    )
    assert free.heading != pytest.approx(one.heading, abs=0.1)


@pytest.mark.slow
def test_the_optimal_evader_maximises_its_table() -> None:
    """Even a coarse table: its value is reached, moving aside is worse."""
    unit, cells = 0.5, 24
    bound = tables.pursuit_bound(cells)
    assert cache_folder().is_dir()
    kept: list[float] = []
    promised: list[float] = []
    aside: list[float] = []
    for seed in range(6):
        starts = generate_room(RoomRecipe(None, None), seed).starts
        assert starts is not None
        pursuer, evader = starts
        x, y = evader.x - pursuer.x, evader.y - pursuer.y
        c, s = cos(pursuer.theta), sin(pursuer.theta)
        away = evader.theta + pi - pursuer.theta
        value = bound.value(
            ((c * x + s * y) / unit, (c * y - s * x) / unit, away)
        )
        promised.append(unit * float(value))
        for found, mind in (
            (kept, LookAhead(cells=cells, obstacles=False)),
            (aside, ASIDE),
        ):
            track = play_strategies(Pursuit(), mind, starts, game=SHORT)
            found.append(float(track.distances.min()))
    assert np.mean(kept) >= 0.97 * np.mean(promised)
    assert np.max(np.subtract(kept, promised)) < 0.02
    assert np.mean(aside) < 0.8 * np.mean(kept)
