"""Test the signals of a game that is played again."""

from dataclasses import replace

import numpy as np
import pytest

from stepaside.games.game_settings import StartSettings
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.game_settings import walk as make_walk
from stepaside.games.player_settings import WALKER
from stepaside.games.recorded_game import run_game
from stepaside.games.replayed_signals import RobotSignals, repeat_game
from stepaside.games.run import Run
from stepaside.robots.description import load_robot


@pytest.fixture(scope="module")
def walk() -> Run:
    return run_game(make_walk(duration=4.0))


@pytest.fixture(scope="module")
def signals(walk: Run) -> RobotSignals:
    repeated = repeat_game(walk)
    assert repeated.reason == ""
    return repeated.robots[WALKER]


@pytest.fixture(scope="module")
def duel() -> Run:
    start = StartSettings(distance=0.9, pursuer_offset=0.0, evader_offset=0.0)
    return run_game(make_duel(duration=3.0, start=start))


def test_a_straight_knee_holds_against_the_weight(
    signals: RobotSignals, walk: Run
) -> None:
    model = load_robot("nao").compile()
    knee = model.joint("LKneePitch").qposadr[0] - 7
    assert signals.joint_effort is not None
    standing = signals.joint_effort[walk.times < 0.5, knee][5:]
    # A bent knee that is loaded from above needs a torque that stretches it.
    assert (standing < -0.1).all()


def test_a_game_that_differs_gives_no_signals_but_a_reason(
    duel: Run,
) -> None:
    track = duel.evader
    assert track.qpos is not None
    qpos = track.qpos.copy()
    qpos[50, 20] += 1e-6
    changed: Run = replace(
        duel,
        tracks={**duel.tracks, "evader": replace(track, qpos=qpos)},
    )
    repeated = repeat_game(changed)
    assert not repeated.robots
    assert "evader moved differently" in repeated.reason


def test_joints_follow_their_targets(walk: Run, signals: RobotSignals) -> None:
    targets = signals.joint_targets
    assert targets is not None and walk.walker.qpos is not None
    names = signals.target_names
    assert targets.shape == (len(walk.times), len(names))
    model = load_robot("nao").compile()
    columns = [model.joint(name).qposadr[0] for name in names]
    angles = walk.walker.qpos[:, columns]
    # Ideal joints are where they were sent a tick of 4 ms before.
    aligned = np.abs(angles - targets).mean()
    assert aligned < 0.004
    assert np.abs(angles[1:] - targets[:-1]).mean() > 2.0 * aligned
