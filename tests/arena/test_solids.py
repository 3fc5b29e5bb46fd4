"""Test distances of moving outlines from solids, along some directions."""

from math import cos, pi, radians

import numpy as np
import pytest

from stepaside.arena import (
    Box,
    Disc,
    Obstacle,
    ObstacleSet,
    Polygon,
    clearance_between,
)
from stepaside.core.poses import Array, Pose

FOOT = np.array([[0.09, 0.04], [-0.05, 0.04], [-0.05, -0.03], [0.09, -0.04]])
COARSE = radians(3.0)  # to the nearest direction, at most


def scene(seed: int) -> tuple[Obstacle, Array]:
    """Something, and an outline that does not touch it."""
    random = np.random.default_rng(seed)
    x, y, turn = random.uniform(-1.0, 1.0, 3).tolist()
    away = Pose(x, y, pi * turn).compose(Pose(1.0, 0.0, 2.0 * turn))
    corners = away.transform_points(FOOT)
    return (Box(x, y, 0.6, 0.3, turn), Disc(x, y, 0.4))[seed % 2], corners


def found(solids: tuple[Obstacle, ...], corners: Array) -> float:
    (least,) = ObstacleSet(solids).swept_clearances(corners[None]).tolist()
    return float(least)


@pytest.mark.parametrize("seed", range(20))
def test_what_it_calls_clear_is_clear(seed: int) -> None:
    """By less than the distance, but for what 3 degrees make of it."""
    solid, corners = scene(seed)
    foot = Polygon(tuple(map(tuple, corners.tolist())))
    exact = clearance_between(foot, solid)
    assert exact > 0.2
    # Both reach at most so far from the line of their nearest points.
    aside = 2.0 * COARSE * 0.5
    told = found((solid,), corners)
    assert exact * cos(COARSE) - aside <= told <= exact + 1e-12


@pytest.mark.parametrize("seed", range(20))
def test_a_quarter_turn_of_everything_changes_no_distance(seed: int) -> None:
    """No side is seen better than another."""
    solid, corners = scene(seed)
    told = found((solid,), corners)
    for quarters in (1, 2, 3):
        turn = Pose(0.0, 0.0, 0.5 * pi * quarters)
        turned = found((solid.moved(turn),), turn.transform_points(corners))
        assert turned == pytest.approx(told, abs=1e-9)


def test_the_nearest_solid_counts() -> None:
    (one, corners), (other, _) = scene(2), scene(5)
    apart = [found((solid,), corners) for solid in (one, other)]
    assert found((one, other), corners) == pytest.approx(min(apart), abs=2e-3)
