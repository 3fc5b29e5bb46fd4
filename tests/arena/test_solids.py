"""Test lower bounds of the clearance of moving outlines."""

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
    """Return a solid and an outline at a distance from it."""
    random = np.random.default_rng(seed)
    x, y, turn = random.uniform(-1.0, 1.0, 3).tolist()
    away = Pose(x, y, pi * turn).compose(Pose(1.0, 0.0, 2.0 * turn))
    corners = away.transform_points(FOOT)
    return (Box(x, y, 0.6, 0.3, turn), Disc(x, y, 0.4))[seed % 2], corners


def found(solids: tuple[Obstacle, ...], corners: Array) -> float:
    (least,) = ObstacleSet(solids).swept_clearances(corners[None]).tolist()
    return float(least)


@pytest.mark.parametrize("seed", range(20))
def test_bound_is_below_the_distance_and_close_to_it(seed: int) -> None:
    """The gap is that of directions 3 degrees off."""
    solid, corners = scene(seed)
    foot = Polygon(tuple(map(tuple, corners.tolist())))
    exact = clearance_between(foot, solid)
    assert exact > 0.2
    # Largest extent of both across the line of their nearest points.
    aside = 2.0 * COARSE * 0.5
    bound = found((solid,), corners)
    assert exact * cos(COARSE) - aside <= bound <= exact + 1e-12


def test_bound_is_that_of_the_nearest_solid() -> None:
    (one, corners), (other, _) = scene(2), scene(5)
    bounds = [found((solid,), corners) for solid in (one, other)]
    assert found((one, other), corners) == pytest.approx(min(bounds), abs=2e-3)
