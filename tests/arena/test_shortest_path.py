"""Test shortest paths around obstacles."""

from math import acos, atan2, hypot, pi, sqrt

import numpy as np
import pytest

from stepaside.arena import (
    NO_OBSTACLES,
    Box,
    Disc,
    Obstacle,
    ObstacleSet,
    RoomRecipe,
    first_waypoint,
    generate_room,
)
from stepaside.core.poses import Pose
from stepaside.strategies import Knowledge, Limits, Pursuit

RADIUS = 0.2
LIMITS = Limits(0.1, 0.2, 0.04, 0.547)
Point = tuple[float, float]


def path(
    solids: tuple[Obstacle, ...], start: Point, end: Point
) -> list[Point]:
    points = [start]
    while points[-1] != end:
        after = first_waypoint(ObstacleSet(solids), points[-1], end, RADIUS)
        assert after is not None and len(points) < 50
        points.append(after)
    return points


def length(points: list[Point]) -> float:
    legs = np.diff(np.array(points), axis=0)
    return float(np.hypot(*legs.T).sum())


def test_free_path_is_straight() -> None:
    assert first_waypoint(NO_OBSTACLES, (0.0, 0.0), (1.0, 2.0), RADIUS) == (
        1.0,
        2.0,
    )
    beside = ObstacleSet((Disc(0.5, 0.31, 0.1),))
    assert first_waypoint(beside, (0.0, 0.0), (1.0, 0.0), RADIUS) == (1.0, 0.0)


def test_path_around_a_disc_is_tangents_and_an_arc() -> None:
    disc, away = Disc(0.0, 0.0, 0.3), 0.3 + RADIUS
    start, end = (-1.0, 0.05), (1.2, 0.05)
    found = length(path((disc,), start, end))
    arc = pi
    exact = 0.0
    for x, y in (start, end):
        far = hypot(x, y)
        exact += sqrt(far**2 - away**2)
        arc -= acos(away / far) + atan2(y, abs(x))
    exact += away * arc
    assert exact < found < 1.03 * exact


def test_path_around_a_wall_passes_its_nearer_end() -> None:
    wall = Box(0.0, 0.3, 0.1, 1.0)  # from y = -0.2 to 0.8
    points = path((wall,), (-0.5, 0.0), (0.5, 0.0))
    assert min(y for _, y in points) < -0.2 - 0.9 * RADIUS
    mirrored = path((Box(0.0, -0.3, 0.1, 1.0),), (-0.5, 0.0), (0.5, 0.0))
    np.testing.assert_allclose(
        np.array(mirrored), np.array(points) * [1, -1], atol=1e-12
    )


def test_paths_keep_their_clearance_in_random_rooms() -> None:
    recipe = RoomRecipe(discs=3, boxes=2, polygons=1)
    for seed in range(3):
        room = generate_room(recipe, seed)
        assert room.starts is not None
        start, end = ((p.x, p.y) for p in room.starts)
        for goal in (end, (-end[0], -end[1])):
            if room.clearance([goal])[0] < RADIUS:
                continue
            points = np.array(path(room.solids, start, goal))
            for a, b in zip(points[:-1], points[1:], strict=True):
                line = a + np.linspace(0.0, 1.0, 200)[:, None] * (b - a)
                assert room.clearance(line).min() > RADIUS - 1e-6


def test_without_a_path_there_is_no_waypoint() -> None:
    cage = tuple(
        Box(x, y, w, d)
        for x, y, w, d in (
            (0.6, 0.0, 0.1, 1.3),
            (-0.6, 0.0, 0.1, 1.3),
            (0.0, 0.6, 1.3, 0.1),
            (0.0, -0.6, 1.3, 0.1),
        )
    )
    known = ObstacleSet(cage)
    assert first_waypoint(known, (0.0, 0.0), (2.0, 0.0), RADIUS) is None


@pytest.mark.parametrize("side", [1, -1])
def test_pursuer_goes_around_a_pillar(side: int) -> None:
    """It does not head for an opponent straight behind a pillar."""
    here = Pose(0.3, -0.2, 0.7)
    placed = Disc(*here.compose(Pose(0.6, -0.02 * side, 0.0))[:2], 0.15)
    known = Knowledge(
        0.0,
        0.0,
        1.5,
        LIMITS,
        pose_in_map=here,
        obstacles_in_map=ObstacleSet((placed,)),
    )
    intent, _ = Pursuit().decide(known, Pursuit().begin())
    assert side * intent.heading > 0.3
    free = Knowledge(0.0, 0.4, 1.5, LIMITS, pose_in_map=here)
    assert Pursuit().decide(free, Pursuit().begin())[0].heading == 0.4


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("turn", [0.0, 2.0, -2.5])
def test_path_takes_the_preferred_side(side: int, turn: float) -> None:
    """Unless the other side is 0.4 m shorter."""
    here = Pose(1.3, -0.7, turn)
    goal = here.compose(Pose(1.0, 0.0, 0.0))
    for beside, preferred in ((0.05, True), (0.3, False)):
        x, y, _ = here.compose(Pose(0.5, side * beside, 0.0))
        wall = Box(x, y, 0.1, 1.0, turn)
        start, end = (here.x, here.y), (goal.x, goal.y)
        corner = first_waypoint(ObstacleSet((wall,)), start, end, RADIUS, side)
        assert corner is not None
        ahead = here.inverse().transform_points([corner])[0]
        assert bool(side * ahead[1] > 0.0) is preferred
