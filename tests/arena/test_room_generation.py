"""Test laws of random rooms: obstacles, initial poses, areas and paths."""

from math import atan2, hypot, pi, radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.arena import Disc, Obstacle, RoomRecipe, generate_room
from stepaside.arena.room import FARTHEST, NEAREST
from stepaside.arena.shapes import MovingBox
from stepaside.core.poses import wrap_angle

RECIPE = RoomRecipe(4.0, 3.0, discs=2, boxes=1, polygons=1, doors=1)


@pytest.mark.parametrize("seed", range(12))
def test_initial_poses_lie_within_the_ranges_of_a_duel(seed: int) -> None:
    """The evader is ahead of the pursuer and nearly faces it."""
    for recipe in (RECIPE, RoomRecipe(None, None)):
        room = generate_room(recipe, seed)
        assert room.starts is not None
        pursuer, evader = room.starts
        x, y = evader.x - pursuer.x, evader.y - pursuer.y
        assert NEAREST - 1e-9 <= hypot(x, y) <= FARTHEST + 1e-9
        sight = atan2(y, x)
        assert abs(wrap_angle(sight - pursuer.theta)) <= pi / 2 + 1e-9
        back = wrap_angle(sight + pi - evader.theta)
        assert abs(back) <= radians(30.0) + 1e-9


@pytest.mark.parametrize("seed", range(12))
def test_obstacles_have_the_given_sizes_and_do_not_overlap(seed: int) -> None:
    room = generate_room(RECIPE, seed)
    assert len(room.obstacles) == 4 and len(room.doors) == 1
    for one in room.obstacles:
        if isinstance(one, Disc):
            radius = one.radius
            middle = np.array(one.centre)
        else:
            middle, radius = _circle_around(one)
        assert 0.1 - 1e-9 <= radius <= 0.25 + 1e-9
        assert abs(middle[0]) + radius <= 2.0 + 1e-9
        assert abs(middle[1]) + radius <= 1.5 + 1e-9
    for i, one in enumerate(room.obstacles):
        for other in room.obstacles[i + 1 :]:
            points = (
                np.array([other.centre])
                if isinstance(other, Disc)
                else other.points
            )
            radius = other.radius if isinstance(other, Disc) else 0.0
            assert float(one.clearance(points).min()) >= radius - 1e-9


@given(st.floats(0.0, 200.0), st.floats(0.5, 5.0), st.floats(-pi, pi))
def test_moving_box_keeps_its_speed_and_heading(
    time: float, later: float, heading: float
) -> None:
    box = MovingBox(0.2, -0.3, 0.4, 0.2, (1.2, 0.5), 0.08, heading)
    before, after = box.place_at(time), box.place_at(time + later)
    distance = hypot(after[0] - before[0], after[1] - before[1])
    assert distance <= 0.08 * later + 1e-9
    fraction = (before[0] - 0.2) / 1.0
    assert -1e-9 <= fraction <= 1.0 + 1e-9
    assert before[1] == pytest.approx(-0.3 + 0.8 * fraction, abs=1e-9)
    there_and_back = 2.0 * box.length / 0.08
    again = box.place_at(time + there_and_back)
    assert again == pytest.approx(before, abs=1e-6)
    swept = box.swept(time, time + later)
    for part in np.linspace(0.0, 1.0, 5):
        corners = box.at(time + part * later).points
        assert float(swept.clearance(corners).max()) <= 1e-9
    sides = np.diff(box.at(time).points, axis=0)
    turned = np.arctan2(sides[:, 1], sides[:, 0]) - heading
    np.testing.assert_allclose(np.sin(2.0 * turned), 0.0, atol=1e-9)


def _circle_around(polygon: Obstacle) -> tuple[np.ndarray, float]:
    """Return centre and radius of the circumcircle."""
    a, b, c = polygon.points[:3]
    matrix = 2.0 * np.array([b - a, c - a])
    middle = np.linalg.solve(matrix, [b @ b - a @ a, c @ c - a @ a])
    away = np.hypot(*(polygon.points - middle).T)
    np.testing.assert_allclose(away, away[0])
    return middle, float(away[0])
