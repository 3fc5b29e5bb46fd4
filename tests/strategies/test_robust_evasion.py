"""Test the evader that does not know its opponent."""

from collections.abc import Iterator
from dataclasses import replace
from math import atan2, cos, hypot, inf, pi, sin

import numpy as np
import pytest

from stepaside.arena import RoomRecipe
from stepaside.core.compilation import load_numba
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose, wrap_angle
from stepaside.strategies import (
    HerdingPursuit,
    Knowledge,
    Limits,
    Pursuit,
    RobustEvasion,
    StepGame,
    Strategy,
    play_strategies,
)
from stepaside.strategies.irregular_pursuit import NoisyPursuit, WaitingPursuit
from stepaside.strategies.opponent_models import (
    MODELS,
    SWAYING_SIGHT,
    ModelFit,
)
from stepaside.strategies.robust_evasion import (
    NEARER,
    PlannedGame,
    RobustMemory,
    actions_of,
    approached,
)
from stepaside.strategies.search.beam_search import beam_search, play_moves
from stepaside.strategies.search.pursuer_model import (
    BeamRules,
    PursuerModel,
    arc_end,
    model_turn,
)
from stepaside.studies.tournament_settings import TournamentSettings
from stepaside.studies.tournament_strategies import pursuer_of, speed_ratio_of

pytestmark = pytest.mark.skipif(
    load_numba() is None, reason='needs the extra "fast"'
)
RULES = BeamRules(0.04, 0.08, 0.08 * pi, 0.35, 0.2, 1, 1)
LIMITS = Limits(0.1, 0.2, 0.04, 0.4)
ROOMS = TournamentSettings(room=RoomRecipe())


@pytest.mark.parametrize("number", range(len(MODELS)))
def test_model_that_walks_explains_its_own_steps(number: int) -> None:
    """Seen by an evader on an arc; the others explain them less well."""
    pursuer, own, fit = (-0.6, 0.1, 1.2), (0.4, -0.2, 2.0), ModelFit()
    for n in range(12):
        fit = fit.observe(0.4 * n, Pose(*own), pursuer[:2], RULES, 0.4)
        turn = model_turn(own, pursuer, MODELS[number], RULES)
        pursuer = arc_end(pursuer, 0.04, turn)
        own = arc_end(own, -0.04, 0.12)
    errors = np.sqrt(fit.errors)
    assert errors[number] == errors.min() and number in fit.plausible()
    assert fit.speed == pytest.approx(1.0, abs=1e-3)


def test_weight_of_a_model_falls_with_its_error() -> None:
    squares = np.array([1.0, 1.1, 1.3, 1.45, 4.0, 1.0, 9.0, 1.2])
    fit = ModelFit(errors=tuple(1e-6 * squares), fitting=SWAYING_SIGHT)
    weights = fit.weights()
    assert weights.max() == weights[0] == weights[5] == 1.0
    assert (np.diff(weights[:3]) < 0.0).all()
    assert (weights[[3, 4, 6]] == 0.0).all()
    assert fit.plausible() == [0, 5]
    assert (ModelFit().weights() == 1.0).all()


def test_where_no_plan_survives_all_it_survives_the_most_likely() -> None:
    """Beside a corner, where each model is survived by another plan."""
    own = np.array([-0.89, -0.96, 0.7])
    starts = [np.array([*own, -0.35, -0.51, -2.3])] * 2
    packed = ROOMS.arena(1002)[0].solid_set.packed
    rules = RULES._replace(width=200, horizon=75, capture=0.385)
    models = MODELS[0], MODELS[6]
    survived = []
    for weights in ([0.9, 0.1], [0.1, 0.9]):
        game = PlannedGame(
            models, starts, np.array(weights), 2, 0, packed, rules
        )
        moves, promised = game.plan(np.empty((0, 2)))
        steps = [
            play_moves(start, moves, model, packed, rules)[0]
            for start, model in zip(starts, models, strict=True)
        ]
        assert promised == pytest.approx(float(np.dot(weights, steps)))
        survived.append(steps)
    assert survived[0][0] == survived[1][1] == 75
    assert survived[0][1] < 75 > survived[1][0]


def test_faster_pursuer_is_seen_to_be_faster() -> None:
    model = PursuerModel(2.0, speed=1.3)
    pursuer, own, fit = (-0.6, 0.1, 1.2), (1.4, -0.2, 2.0), ModelFit()
    for n in range(5):
        fit = fit.observe(0.4 * n, Pose(*own), pursuer[:2], RULES, 0.4)
        turn = model_turn(own, pursuer, model, RULES)
        pursuer = arc_end(pursuer, 1.3 * 0.04, turn)
    assert fit.speed == pytest.approx(1.3, abs=0.01)


def sights_of_walkers(
    model: PursuerModel, sway: float, noise: float, seed: int = 0
) -> Iterator[tuple[ModelFit, tuple[float, float, float]]]:
    """Yield the fit and the true pose of a walking pursuer after each step.

    Both bodies sway to alternate sides; the evader zigzags away.
    """
    generator = np.random.default_rng(seed)
    pursuer, own, fit = (-0.9, 0.1, 0.4), (0.3, 0.5, 3.6), ModelFit()
    for n in range(40):
        side = sway if n % 2 else -sway
        x = pursuer[0] - side * sin(pursuer[2]) + side * sin(own[2])
        y = pursuer[1] + side * cos(pursuer[2]) - side * cos(own[2])
        x, y = np.array([x, y]) + noise * generator.normal(size=2)
        fit = fit.observe(0.4 * n, Pose(*own), (x, y), RULES, 0.4, sways=True)
        yield fit, pursuer
        turn = model_turn(own, pursuer, model, RULES)
        pursuer = arc_end(pursuer, 0.04, turn)
        own = arc_end(own, -0.04, 0.2 if n % 16 < 8 else -0.2)


def test_a_pursuer_that_sways_is_not_seen_to_be_faster() -> None:
    fits = [fit for fit, _ in sights_of_walkers(MODELS[0], 0.02, 0.0)]
    assert max(fit.speed for fit in fits) < 1.05


@pytest.mark.parametrize(
    ("number", "wrong"), [(0, {5, 6}), (3, {5, 6}), (5, {0, 6}), (6, {0, 5})]
)
def test_model_of_a_swaying_pursuer_stays_and_others_are_ruled_out(
    number: int, wrong: set[int]
) -> None:
    """With the sway of NAO, and an error of 1 mm, within 15 steps.

    Until then more dangerous models may take the places of the true one.
    """
    for seed in range(5):
        fits = [
            fit
            for fit, _ in sights_of_walkers(MODELS[number], 0.0125, 1e-3, seed)
        ]
        for fit in fits[15:]:
            assert number in fit.plausible()
            assert not wrong & set(fit.plausible())


@pytest.mark.parametrize("number", range(6))
def test_pose_of_a_swaying_pursuer_is_known_within_2_mm(number: int) -> None:
    """Half a step after the mean of two positions the body is at the last."""
    walks = list(sights_of_walkers(MODELS[number], 0.0125, 0.0))
    for fit, (x, y, theta) in walks[8:]:
        pose = fit.pose(number, RULES, 0.5)
        assert hypot(pose.x - x, pose.y - y) < 0.002
        assert abs(wrap_angle(pose.theta - theta)) < 0.01


def test_lag_of_the_own_torso_is_removed_from_sightings() -> None:
    """A torso that lags by 0.05 of the last turn sees the pursuer aside."""
    evader, memory, before = RobustEvasion(10, 5), RobustMemory(), 0.0
    for n, theta in enumerate((0.0, 0.2, 0.1)):
        bearing = wrap_angle(1.0 - theta + 0.05 * (theta - before))
        own, before = Pose(0.0, 0.0, theta), theta
        known = Knowledge(
            0.4 * n,
            bearing,
            1.2,
            LIMITS,
            pose_in_map=own,
            step_start_in_map=own,
        )
        _, memory = evader.decide(known, memory)
        seen = memory.fit.seen[3:5]
        assert seen == pytest.approx((1.2 * cos(1.0), 1.2 * sin(1.0)))


def test_unseen_steps_begin_the_path_anew() -> None:
    *_, (fit, _) = sights_of_walkers(MODELS[0], 0.0125, 0.0)
    later = fit.observe(30.0, Pose(0.5, 0.5, 0.0), (1.0, 0.5), RULES, 0.4)
    assert later.pose(0, RULES, 0.0) == pytest.approx((1.0, 0.5, pi))
    assert later.errors == fit.errors


def test_it_looks_further_ahead_the_fewer_opponents_are_plausible() -> None:
    planned = {
        len(memory.assumed): memory.planned
        for _, memory in decisions(RobustEvasion(20, 20), MODELS[4], 40)
    }
    assert planned == {3: 20, 2: 30, 1: 60}


def decisions(
    evader: RobustEvasion, model: PursuerModel, number: int
) -> Iterator[tuple[Knowledge, RobustMemory]]:
    """Yield knowledge and memory after each decision on an open floor."""
    pursuer, own = (-1.0, 0.1, 1.2), (0.4, -0.2, 2.0)
    memory = evader.begin()
    for n in range(number):
        x, y = pursuer[0] - own[0], pursuer[1] - own[1]
        bearing = wrap_angle(atan2(y, x) - own[2])
        known = Knowledge(
            0.4 * n, bearing, hypot(x, y), LIMITS, pose_in_map=Pose(*own)
        )
        intent, memory = evader.decide(known, memory)
        yield known, memory
        turn = model_turn(own, pursuer, model, RULES)
        pursuer = arc_end(pursuer, model.speed * 0.04, turn)
        turn = RULES.share * intent.heading
        own = arc_end(own, -0.04 * intent.speed_factor, turn)


def test_plan_that_keeps_its_promise_is_kept() -> None:
    """Against a known pursuer the rest survives as long as promised."""
    evader, kept = RobustEvasion(20, 20), 0
    (_, before), *later = decisions(evader, MODELS[3], 40)
    for _, memory in later:
        if len(memory.moves) < memory.planned:
            kept += 1
            np.testing.assert_array_equal(memory.moves, before.moves[1:])
            assert memory.promised == before.promised - 1
        before = memory
    assert kept > 20


def test_plan_is_searched_again_when_the_pursuer_departs_from_it() -> None:
    evader = RobustEvasion(20, 20)
    *_, (known, memory) = decisions(evader, MODELS[3], 24)
    assert len(memory.moves) < memory.planned
    behind = replace(known, time=9.6, bearing=pi, distance=0.4)
    _, after = evader.decide(behind, memory)
    assert len(after.moves) == after.planned < memory.planned


def survival(
    evader: Strategy, pursuer: Strategy, seed: int, duration: float
) -> float:
    room, starts = ROOMS.arena(seed)
    game = StepGame(duration=duration)
    track = play_strategies(pursuer, evader, starts, room=room, game=game)
    return float(track.times[-1])


def test_herding_is_survived_in_a_room() -> None:
    assert survival(RobustEvasion(), HerdingPursuit(), 1000, 90.0) > 89.0


def test_sharp_pursuer_needs_0_8_of_the_time_of_an_offline_search() -> None:
    """The search knows the pursuer; the evader has to find it out."""
    room, (pursuer, evader) = ROOMS.arena(1000)
    path = beam_search(
        np.array([*evader, *pursuer]),
        actions_of(RULES.largest),
        PursuerModel(12.5),
        room.solid_set.packed,
        RULES._replace(width=1000, horizon=450),
    )
    sharp = Pursuit(gain_ratio=inf)
    online = survival(RobustEvasion(), sharp, 1000, 180.0)
    assert 0.8 * 0.4 * len(path) < online < 180.0


def test_faster_pursuer_of_the_paper_is_survived_on_an_open_floor() -> None:
    settings = TournamentSettings(room=RoomRecipe(None, None))
    game = StepGame(pursuer_speed_ratio=1.1, duration=90.0)
    _, starts = settings.arena(1002)
    track = play_strategies(Pursuit(), RobustEvasion(), starts, game=game)
    assert not track.captured


def test_same_knowledge_gives_the_same_game() -> None:
    noisy = NoisyPursuit(seed=3)
    tracks = [
        play_strategies(
            noisy,
            RobustEvasion(width=20, horizon=20),
            ROOMS.arena(1004)[1],
            room=ROOMS.arena(1004)[0],
            game=StepGame(duration=12.0),
        )
        for _ in range(2)
    ]
    np.testing.assert_array_equal(tracks[0].pursuer, tracks[1].pursuer)
    np.testing.assert_array_equal(tracks[0].evader, tracks[1].evader)


def test_waiting_pursuer_stands_and_goes_on() -> None:
    track = play_strategies(
        WaitingPursuit(3.9, 2.05),
        RobustEvasion(width=10, horizon=10),
        ROOMS.arena(1004)[1],
        game=StepGame(duration=12.0),
    )
    moved = np.hypot(*np.diff(track.pursuer[:, :2], axis=0).T)
    assert (moved[10:15] == 0.0).all() and (moved[:10] > 0.03).all()
    assert (moved[15:25] > 0.03).all()


def test_speed_of_a_pursuer_is_in_its_name() -> None:
    assert speed_ratio_of("sharp-v1.3") == 1.3
    assert speed_ratio_of("pure-x2-v0.8") == 0.8
    assert speed_ratio_of("stop-and-wait") == 1.0
    assert pursuer_of("pure-x2-v0.8") == Pursuit(gain_ratio=2.0)
    with pytest.raises(ConfigurationError, match="RATIO of -vRATIO must"):
        pursuer_of("pure-v30")


def test_pursuer_walks_at_its_speed() -> None:
    game = StepGame(pursuer_speed_ratio=1.3, duration=4.0)
    starts = Pose(0.0, 0.0, 0.0), Pose(2.0, 0.0, pi)
    track = play_strategies(
        Pursuit(), RobustEvasion(10, 10), starts, game=game
    )
    moved = np.hypot(*np.diff(track.pursuer[:, :2], axis=0).T)
    assert moved == pytest.approx(1.3 * 0.04, rel=0.02)


def test_evader_that_no_step_saves_searches_again() -> None:
    """A pursuer that would have captured it walks past."""
    evader = RobustEvasion(20, 20)
    near = Knowledge(0.0, 0.0, 0.351, LIMITS, pose_in_map=Pose(0.0, 0.0, pi))
    _, lost = evader.decide(near, evader.begin())
    _, saved = evader.decide(replace(near, time=0.4, distance=1.5), lost)
    assert len(lost.moves) < 5 < len(saved.moves)


def test_walker_that_is_nearer_than_the_capture_distance_still_flees() -> None:
    evader, own = RobustEvasion(20, 20), Pose(0.0, 0.0, pi)
    near = Knowledge(
        0.0, 0.0, 0.34, LIMITS, pose_in_map=own, step_start_in_map=own
    )
    intent, memory = evader.decide(near, evader.begin())
    assert len(memory.moves) > 5 and intent.speed_factor == 1.0
    still = replace(near, step_start_in_map=None)
    _, lost = evader.decide(still, evader.begin())
    assert len(lost.moves) == 0


def test_pursuer_with_errors_is_nearer_and_turned() -> None:
    own, seen = Pose(0.3, -0.2, 1.0), Pose(-0.5, 0.4, 0.7)
    for turn in (-0.2, 0.2):
        pose = approached(own, seen, turn)
        before, after = (hypot(own.x - p.x, own.y - p.y) for p in (seen, pose))
        assert before - after == pytest.approx(NEARER)
        assert pose.theta - seen.theta == pytest.approx(turn)
