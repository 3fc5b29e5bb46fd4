"""Test the beam search and its model of the pursuer."""

from math import inf, pi

import numpy as np
import pytest

from floor_duels import play_steps
from stepaside.arena import NO_OBSTACLES, ObstacleSet, Room
from stepaside.core.poses import Pose
from stepaside.strategies import Pursuit, Strategy
from stepaside.strategies.robust_evasion import actions_of
from stepaside.strategies.search.beam_search import (
    BeamRules,
    arc_cosine,
    beam_search,
)
from stepaside.strategies.search.step_motion import (
    ENOUGH,
    Objective,
    PlayerPair,
    PursuerModel,
    StepRules,
    pair_of,
    pursue,
    roll_out,
)

STEP = StepRules(0.04, 0.08, 0.08 * pi)
RULES = BeamRules(60, 50)
MODEL, SHARP = PursuerModel(), PursuerModel(12.5)
START = pair_of((0.5, 0.2, 0.3), (-0.5, -0.1, 0.9))
ROOM = Room(3.0, 3.0).solid_set


def objective(obstacles: ObstacleSet) -> Objective:
    return Objective(STEP, obstacles.packed, 0.2, capture=0.35)


def survive(
    start: PlayerPair, moves: np.ndarray, obstacles: ObstacleSet = ROOM
) -> tuple[float, int]:
    """Return the least distance of moves, and the steps that they survive."""
    number, aims = len(moves), objective(obstacles)
    return roll_out(start, ENOUGH, moves, number, -inf, SHARP, aims)[1:]


@pytest.mark.parametrize(
    ("model", "pursuer"),
    [
        (PursuerModel(), Pursuit()),
        (PursuerModel(3.0), Pursuit(gain=3.0)),
        (SHARP, Pursuit(gain=inf)),
        (PursuerModel(1.0, pull=1.0), Pursuit(pull=1.0)),
    ],
    ids=["pursuit", "x3", "sharp", "herding"],
)
def test_model_walks_as_the_strategy_does(
    model: PursuerModel, pursuer: Strategy
) -> None:
    """Over 40 steps of a game, against an evader that moves aside."""
    from stepaside.strategies import Evasion

    starts = Pose(-0.5, -0.1, 0.9), Pose(0.5, 0.2, 0.3)
    evader = Evasion(safety_radius=1e6)
    track = play_steps(pursuer, evader, starts, 40, capture=1e-3)
    for before, own, after in zip(
        track.pursuer, track.evader, track.pursuer[1:], strict=False
    ):
        end = pursue(pair_of(tuple(own), tuple(before)), model, STEP)
        np.testing.assert_allclose(end[:2], after[:2], atol=1e-6)


def test_path_survives_as_long_as_it_says() -> None:
    actions = actions_of(STEP.largest)
    path = beam_search(START, actions, SHARP, objective(ROOM), RULES)
    least, steps = survive(START, actions[path])
    assert steps == len(path) == RULES.horizon
    assert 0.35 < least < ENOUGH


def test_evader_that_is_too_near_to_a_wall_may_only_leave_it() -> None:
    inside = pair_of((-1.32, 0.0, 0.0), (1.0, 0.0, pi))
    into, out = np.array([[0.0, 1.0]]), np.array([[0.0, -1.0]])
    turn = np.array([[0.25, 0.0]])
    played = [survive(inside, moves)[1] for moves in (into, out, turn)]
    assert played == [0, 1, 1]


def test_captured_and_touching_moves_do_not_survive() -> None:
    near = pair_of((0.3, 0.0, 0.0), (-0.06, 0.0, 0.0))
    walk_into = np.array([[0.0, 0.0]])
    assert survive(near, walk_into, NO_OBSTACLES) == (ENOUGH, 0)
    beside = pair_of((-1.29, 0.0, 0.0), (1.0, 0.0, pi))
    back = np.array([[0.0, 1.0]])
    assert survive(beside, back)[1] == 0
    assert survive(beside, back, NO_OBSTACLES)[1] == 1


def test_the_arc_cosine_is_that_of_both_half_planes() -> None:
    for angle in np.linspace(0.0, np.pi, 50):
        assert arc_cosine(np.cos(angle)) == pytest.approx(angle, abs=7e-5)
