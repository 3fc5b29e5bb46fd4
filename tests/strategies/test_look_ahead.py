"""Test predictive evaders, alone and in step games."""

from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from floor_duels import play_steps
from stepaside.arena import Disc, ObstacleSet, Room, RoomRecipe, generate_room
from stepaside.core.poses import Pose
from stepaside.games import Outcome
from stepaside.strategies import (
    Evasion,
    Knowledge,
    Limits,
    LookAhead,
    Pursuit,
    Strategy,
)
from stepaside.theory.value import table
from stepaside.theory.value import two_cars as tables

NAO = Limits(0.1, 0.2, 0.04, 0.4)
FACING = (Pose(0.0, 0.0, 0.6), Pose(1.0, 0.1, 3.3))
SHORT = 75  # steps
ASIDE = Evasion(safety_radius=100.0, side_hysteresis=0.0)


def know(
    bearing: float, distance: float, pose: Pose, time: float
) -> Knowledge:
    return Knowledge(time, bearing, distance, NAO, pose_in_map=pose)


@pytest.mark.parametrize("seed", [1, 3])
def test_in_a_room_it_survives_where_moving_aside_touches(seed: int) -> None:
    room = generate_room(RoomRecipe(discs=3), seed)
    assert room.starts is not None

    def play(evader: Strategy) -> Outcome:
        assert room.starts is not None
        track = play_steps(Pursuit(), evader, room.starts, 150, room=room)
        if track.outcome is Outcome.COMPLETED:
            assert len(track.distances) == 150 + 1
            assert track.distances.min() > 0.35
            assert track.clearances.min() >= 0.2
        return track.outcome

    assert play(ASIDE) is Outcome.TOUCHED
    assert play(LookAhead()) is Outcome.COMPLETED


def test_with_its_back_in_a_corner_it_turns_before_it_walks() -> None:
    """Every sequence of steps from here is caught within 17."""
    room = generate_room(RoomRecipe(), 314)
    assert room.starts is not None
    track = play_steps(Pursuit(), LookAhead(), room.starts, 40, room=room)
    assert track.outcome is Outcome.COMPLETED


def test_it_rather_stands_than_touches() -> None:
    """Its back is at a disc, and backward is the only way it has."""
    room = Room(obstacles=(Disc(0.5, 0.0, 0.29),))
    starts = (Pose(-1.0, 0.0, 0.0), Pose(0.0, 0.0, pi))
    track = play_steps(Pursuit(), LookAhead(), starts, SHORT, room=room)
    assert track.clearances.min() >= 0.2
    alone = play_steps(Pursuit(), ASIDE, starts, SHORT, room=room)
    assert alone.outcome is Outcome.TOUCHED


def test_it_knows_the_map_in_its_own_odometry() -> None:
    """Room and players turned and shifted together: the same decision."""
    mind, disc = LookAhead(), Disc(-0.5, 0.03, 0.2)
    here = know(0.1, 0.8, Pose(0.0, 0.0, 0.0), 0.0)
    frame = Pose(2.0, -1.0, 1.3)
    moved = Disc(*frame.compose(Pose(disc.x, disc.y, 0.0))[:2], disc.radius)
    there = replace(
        here, pose_in_map=frame, obstacles_in_map=ObstacleSet((moved,))
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
def test_the_optimal_evader_maximises_its_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even a coarse table: its value is reached, moving aside is worse."""
    monkeypatch.setattr(table, "cache_folder", lambda: tmp_path)
    unit, cells = 0.5, 24
    bound = tables.pursuit_bound(cells)
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
            track = play_steps(Pursuit(), mind, starts, SHORT)
            found.append(float(track.distances.min()))
    assert np.mean(kept) >= 0.97 * np.mean(promised)
    assert np.max(np.subtract(kept, promised)) < 0.02
    assert np.mean(aside) < 0.8 * np.mean(kept)
