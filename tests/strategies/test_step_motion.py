"""Test the step game: one step, clearance, values, and the search."""

from itertools import product
from math import atan2, cos, inf, pi, sin
from typing import Any

import numpy as np
import pytest

from stepaside.arena import (
    NO_OBSTACLES,
    Box,
    Disc,
    ObstacleSet,
    RoomRecipe,
    generate_room,
)
from stepaside.core.poses import Pose
from stepaside.planning import Direction
from stepaside.planning.path import UnicycleTrajectory
from stepaside.strategies.search.distance_field import (
    CELL,
    DistanceField,
    distance_field,
    field_clearance,
)
from stepaside.strategies.search.step_motion import (
    PlayerPair,
    PursuerModel,
    StepRules,
    pair_of,
)
from stepaside.strategies.search.step_motion import step_both as step
from stepaside.strategies.search.turn_search import (
    NO_VALUE,
    BestManeuver,
    PursuitValues,
    TurnSearch,
    judge,
    law_turn,
    look_ahead,
    value_at,
)
from stepaside.theory.value import PoseGrid, ValueTable
from stepaside.theory.value.solver import make_rules

RULES, MODEL = StepRules(0.04, 0.08, 0.08 * pi), PursuerModel()
ROOM = generate_room(RoomRecipe(discs=3, boxes=2, polygons=2, doors=1), 4)
PACKED, NOTHING = ROOM.solid_set.packed, NO_OBSTACLES.packed


def place(evader: Pose, pursuer: Pose) -> PlayerPair:
    return pair_of(evader, pursuer)


def step_both(both: PlayerPair, turn: float, pace: float = 1.0) -> PlayerPair:
    return step(both, turn, pace, MODEL, RULES)


def found_by(
    both: PlayerPair,
    tried: TurnSearch,
    packed: Any = NOTHING,
    table: PursuitValues = NO_VALUE,
) -> BestManeuver:
    return look_ahead(both, np.zeros(0), 0, tried, MODEL, RULES, packed, table)


def field_of(packed: Any, aims: TurnSearch, both: PlayerPair) -> DistanceField:
    """Return the field that a search from a state uses."""
    return distance_field(packed, aims.clearance, both.ex, both.ey, 1.0)


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


@pytest.mark.parametrize("seed", range(3))
def test_the_distance_field_is_a_safe_and_tight_bound(seed: int) -> None:
    """Within its cells and beyond, also where a cell has many neighbours."""
    room = generate_room(RoomRecipe(discs=3, boxes=2, polygons=2), seed)
    heap = [Box(0.6 + 0.02 * n, 0.6, 0.05, 0.05, 0.1 * n) for n in range(20)]
    solids = ObstacleSet((*room.solids, *heap))
    enough = 0.3
    field = distance_field(solids.packed, enough, 0.2, -0.1, 1.2)
    random = np.random.default_rng(seed)
    points = random.uniform(-1.7, 1.7, (1500, 2))
    exact = np.minimum(solids.clearance(points), enough)
    found = [field_clearance(field, x, y) for x, y in points.tolist()]
    np.testing.assert_allclose(found, exact, atol=1e-12)
    cells = np.floor((points - (field.x, field.y)) / CELL).astype(int)
    inside = np.all((cells >= 0) & (cells < len(field.bounds)), axis=1)
    assert 200 < inside.sum() < 1400
    bounds = field.bounds[tuple(cells[inside].T)]
    diagonal = CELL * 2.0**0.5
    assert np.all(bounds <= exact[inside] + 1e-12)
    assert np.all(bounds >= exact[inside] - diagonal - 1e-12)


@pytest.fixture(scope="module")
def bound() -> ValueTable:
    """A table of anything; nothing is solved."""
    grid = PoseGrid.covering(0.25, 3.0, 3.0, 3.0, 12)
    values = np.random.default_rng(2).uniform(0.1, 0.3, grid.shape)
    motions = np.zeros((1, 4, 3))
    rules = make_rules(grid, inf)
    return ValueTable(values, values, motions, motions, rules, 0.0, 0.0)


def value_table(bound: ValueTable) -> PursuitValues:
    grid = bound.grid
    return PursuitValues(bound.values, grid.left, grid.spacing, 0.5)


def brute(
    both: PlayerPair,
    tried: TurnSearch,
    packed: Any,
    table: Any,
    *,
    law: bool = True,
) -> float:
    """Best score of all sequences and of the law, without leaving any out."""
    best, field = -inf, field_of(packed, tried, both)
    pieces = tried.pieces.tolist()
    sequences = [
        [u for u, n in zip(each, pieces, strict=True) for _ in range(n)]
        for each in product(tried.turns.tolist(), repeat=len(pieces))
    ]
    for turns in [*([[]] if law else []), *sequences]:
        here, score, side = both, tried.enough, 0.0
        for n in range(tried.horizon):
            if n < len(turns):
                u = turns[n]
            else:
                dx, dy = here.px - here.ex, here.py - here.ey
                left = here.ec * dy - here.es * dx
                side = side or (-1.0 if left > 0.0 else 1.0)
                u = law_turn(here, side, tried.angle, RULES.share)
            here = step_both(here, u)
            score = judge(here, score, tried, field)
        if table.values.size:
            score = min(score, value_at(table, here))
        best = max(best, score)
    return best


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("valued", [False, True])
def test_the_search_matches_brute_force(
    seed: int, valued: bool, bound: ValueTable
) -> None:
    """Its score is the best of all, and the turns it gives have it."""
    random = np.random.default_rng(seed)
    evader = Pose(*random.uniform([-1, -1, -pi], [1, 1, pi]).tolist())
    pursuer = Pose(*random.uniform([-1, -1, -pi], [1, 1, pi]).tolist())
    both = place(evader, pursuer)
    tried = TurnSearch(
        np.array([2, 3, 6]),
        np.array([0.0, -0.1, 0.1, -0.25, 0.25]),
        20,
        enough=0.7,
        clearance=0.25,
        sight=2.0,
        gain=0.0,
    )
    packed = NOTHING if valued else PACKED
    table = value_table(bound) if valued else NO_VALUE
    found = found_by(both, tried, packed, table)
    expected = brute(both, tried, packed, table)
    assert found.score == pytest.approx(expected, abs=1e-7)
    score, here, field = tried.enough, both, field_of(packed, tried, both)
    for turn in found.turns:
        here = step_both(here, turn)
        score = judge(here, score, tried, field)
    if valued:
        score = min(score, value_at(table, here))
    assert score == pytest.approx(expected, abs=1e-7)


def test_missing_clearance_and_lost_sight_are_penalised() -> None:
    both = place(Pose(0.0, 0.0, 0.0), Pose(1.0, 1.0, 0.0))
    x, y, radius = 0.4, -0.3, 0.15
    disc = ObstacleSet((Disc(x, y, radius),)).packed
    near = both._replace(
        ex=x + radius + 0.15, ey=y, px=x + radius + 1.15, py=y
    )
    aims = TurnSearch(np.zeros(0), np.zeros(0), 1, enough=0.9, penalty=3.0)
    assert judge(near, 0.9, aims, field_of(disc, aims, near)) == pytest.approx(
        0.9 - 3.0 * 0.05
    )
    behind = both._replace(px=cos(2.5), py=sin(2.5))
    aims = aims._replace(sight=2.0)
    blind = judge(behind, 0.9, aims, field_of(NOTHING, aims, behind))
    assert blind == pytest.approx(0.9 - 0.1 * 0.5)
    assert atan2(behind.py, behind.px) == pytest.approx(2.5)


@pytest.mark.parametrize("seed", range(4))
def test_it_turns_on_the_spot_first_only_if_that_is_better(seed: int) -> None:
    """The score is the best of all trees, each behind its turns."""
    random = np.random.default_rng(seed)
    evader = Pose(1.2, 1.2, float(random.uniform(-pi, pi)))
    pursuer = Pose(*random.uniform([0.3, 0.3, -pi], [0.7, 0.7, pi]).tolist())
    both = place(evader, pursuer)
    tried = TurnSearch(
        np.array([2, 3]),
        np.array([0.0, -0.25, 0.25]),
        9,
        spots=4,
        enough=0.8,
        penalty=60.0,
        tight=inf,
    )
    best = brute(both, tried, PACKED, NO_VALUE)
    field = field_of(PACKED, tried, both)
    for side in (-0.25, 0.25):
        here, score = both, tried.enough
        for n in range(4):
            here = step_both(here, side, 0.05)
            score = judge(here, score, tried, field)
            if n % 2:
                behind = tried._replace(enough=score)
                best = max(
                    best, brute(here, behind, PACKED, NO_VALUE, law=False)
                )
    found = found_by(both, tried, PACKED)
    assert found.score == pytest.approx(best, abs=1e-5)
    assert len(found.turns) == 9 + found.spot
    here, score = both, tried.enough
    for n, turn in enumerate(found.turns):
        here = step_both(here, turn, 0.05 if n < found.spot else 1.0)
        score = judge(here, score, tried, field)
    assert score == pytest.approx(found.score, abs=1e-9)
