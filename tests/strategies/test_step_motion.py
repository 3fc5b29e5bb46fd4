"""Test one step, clearance, and the search over turning sequences."""

from math import cos, inf, pi, sin
from typing import Any

import numpy as np
import pytest

from stepaside.arena import (
    NO_OBSTACLES,
    Disc,
    ObstacleSet,
    RoomRecipe,
    generate_room,
)
from stepaside.core.poses import Pose
from stepaside.planning import Direction
from stepaside.planning.path import UnicycleTrajectory
from stepaside.strategies.knowledge import ON_THE_SPOT
from stepaside.strategies.look_ahead import (
    BLINDNESS,
    HORIZON,
    LAW,
    PIECES,
    SIGHT,
    even_turns,
    look_ahead,
)
from stepaside.strategies.search.step_motion import (
    Objective,
    PlayerPair,
    PursuerModel,
    StepRules,
    judge,
    pair_of,
    required,
    roll_out,
)
from stepaside.strategies.search.step_motion import step_both as step

RULES, MODEL = StepRules(0.04, 0.08, 0.08 * pi), PursuerModel()
ROOM = generate_room(RoomRecipe(discs=3, boxes=2, polygons=2, doors=1), 4)
PACKED, NOTHING = ROOM.solid_set.packed, NO_OBSTACLES.packed


def place(evader: Pose, pursuer: Pose) -> PlayerPair:
    return pair_of(evader, pursuer)


def step_both(both: PlayerPair, turn: float, pace: float = 1.0) -> PlayerPair:
    return step(both, turn, pace, MODEL, RULES)


@pytest.mark.parametrize(("bearing", "aim"), [(0.4, 0.7), (-2.0, -3.0)])
def test_a_step_is_the_arc_of_both_unicycles(
    bearing: float, aim: float
) -> None:
    """Eqs. (8)-(11) for the time of a stride, 0.4 s."""
    pursuer, sight = Pose(0.3, -0.2, 0.5), 0.5 + aim
    evader = Pose(0.3 + cos(sight), -0.2 + sin(sight), sight + pi - bearing)
    turn = 0.08 * (bearing + 0.3)
    found = step_both(place(evader, pursuer), turn)
    for pose, heading, direction, got in (
        (evader, bearing + 0.3, Direction.BACKWARD, found[:4]),
        (pursuer, aim, Direction.FORWARD, found[4:]),
    ):
        path = UnicycleTrajectory(heading, 0.1, 0.2, direction)
        after = pose.compose(Pose(*path.poses([0.4])[0].tolist()))
        c, s = cos(after.theta), sin(after.theta)
        np.testing.assert_allclose(got, (after.x, after.y, c, s), atol=1e-9)


TURNS, GAIN = even_turns(7, RULES.largest), 1e-6
AIMS = Objective(
    RULES, PACKED, 0.205, penalty=60.0, blindness=BLINDNESS, sight=cos(SIGHT)
)


def search(both: PlayerPair, plan: Any) -> Any:
    return look_ahead(both, np.reshape(plan, (-1, 2)), TURNS, GAIN, AIMS)


def walked(both: PlayerPair, moves: Any) -> float:
    """Return the score of a maneuver, step by step."""
    score = AIMS.enough
    for turn, pace in moves:
        both = step_both(both, turn, pace)
        score, _, _ = judge(both, score, 0.0, -1.0, AIMS)
    return score


def random_pair(random: np.random.Generator) -> PlayerPair:
    evader = Pose(*random.uniform([-1, -1, -pi], [1, 1, pi]).tolist())
    pursuer = Pose(*random.uniform([-1, -1, -pi], [1, 1, pi]).tolist())
    return place(evader, pursuer)


@pytest.mark.parametrize("penalty", [60.0, inf])
def test_a_rollout_scores_every_step_and_ends_when_it_is_lost(
    penalty: float,
) -> None:
    """Clearances that it does not measure again are large enough."""
    random, lost = np.random.default_rng(2), 0
    aims = AIMS._replace(penalty=penalty, capture=0.05)
    for _ in range(200):
        both = random_pair(random)
        turns = np.repeat(random.choice(TURNS, 5), 8)
        moves = np.stack([turns, random.choice([0.05, 1.0], 40)], axis=1)
        found = roll_out(both, 0.8, moves, 40, -inf, MODEL, aims)[1:]
        score, n = 0.8, 0
        _, _, clear = judge(both, score, inf, -inf, aims)
        for n, (turn, pace) in enumerate(moves, 1):
            least = required(clear, pace) if penalty == inf else 0.0
            both = step_both(both, turn, pace)
            later, _, clear = judge(both, score, least, -inf, aims)
            if later == -inf:
                n, lost = n - 1, lost + 1
                break
            score = later
        assert found[0] == pytest.approx(score, abs=1e-12)
        assert found[1] == n
    assert (lost > 50) == (penalty == inf)
    assert required(-0.01, 1.0) > -0.01 >= required(-0.01, 0.05)


@pytest.mark.parametrize("seed", range(8))
def test_the_maneuver_found_beats_others(seed: int) -> None:
    """The law, random sequences, and a given plan, on which it improves."""
    random = np.random.default_rng(seed)
    both = random_pair(random)
    found = search(both, ())
    score = walked(both, found)
    for _ in range(30):
        turns = np.repeat(random.choice(TURNS, len(PIECES)), PIECES)
        plan = np.stack([turns, np.ones(len(turns))], axis=1)
        given = search(both, plan)
        spots = int(np.sum(given[:, 1] == ON_THE_SPOT))
        assert len(given[len(plan) :]) == LAW + spots
        assert score >= walked(both, plan) - 1e-6
        assert walked(both, given) >= score - 1e-6
    assert walked(both, search(both, found)[:HORIZON]) >= score - 1e-9


def test_in_a_corner_it_turns_on_the_spot_first() -> None:
    corner = place(Pose(1.25, 1.25, -pi * 0.75), Pose(0.75, 0.75, pi / 4))
    found = search(corner, ())
    spot = int(np.argmax(found[:, 1] == 1.0))
    assert spot > 0 and spot % 2 == 0
    assert len(found) == HORIZON + spot and (found[spot:, 1] == 1.0).all()
    assert set(np.abs(found[:spot, 0])) == {RULES.largest}


def test_missing_clearance_and_lost_sight_are_penalised() -> None:
    both = place(Pose(0.0, 0.0, 0.0), Pose(1.0, 1.0, 0.0))
    x, y, radius = 0.4, -0.3, 0.15
    disc = ObstacleSet((Disc(x, y, radius),)).packed

    def judged(both: PlayerPair, packed: Any) -> float:
        return judge(both, 0.9, 0.0, -1.0, AIMS._replace(packed=packed))[0]

    near = both._replace(
        ex=x + radius + 0.195, ey=y, px=x + radius + 1.195, py=y
    )
    assert judged(near, disc) == pytest.approx(0.8 - 60.0 * 0.01)
    behind = both._replace(px=cos(3.0), py=sin(3.0))
    assert judged(behind, NOTHING) == pytest.approx(
        0.8 - BLINDNESS * (3.0 - SIGHT)
    )
