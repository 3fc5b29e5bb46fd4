"""Test cells of Apollonius: circles, half planes, hulls."""

from math import inf, pi, sqrt, tau

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.teams.apollonius import ApolloniusCell

ORIGIN = np.zeros(2)
ANGLES = np.linspace(-pi, pi, 61)


def test_a_faster_pursuer_leaves_a_circle() -> None:
    """Centre and radius of the circle of Apollonius in closed form."""
    pursuer, ratio = np.array([[3.0, 1.0]]), 0.6
    cell = ApolloniusCell(ORIGIN, pursuer, ratio)
    edge = cell.extent(ANGLES)[:, None] * np.column_stack(
        [np.cos(ANGLES), np.sin(ANGLES)]
    )
    scale = ratio**2 / (1.0 - ratio**2)
    centre = -scale * pursuer[0]
    radius = ratio / (1.0 - ratio**2) * sqrt(10.0)
    np.testing.assert_allclose(np.hypot(*(edge - centre).T), radius)
    assert cell.is_bounded
    assert cell.area() == pytest.approx(pi * radius**2, rel=1e-6)


def test_both_reach_the_edge_at_the_same_time() -> None:
    rng = np.random.default_rng(2)
    for ratio in (0.3, 0.9, 1.0):
        pursuers = rng.uniform(-2.0, 2.0, (4, 2))
        evader = rng.uniform(-1.0, 1.0, 2)
        cell = ApolloniusCell(evader, pursuers, ratio)
        reach = cell.extent(ANGLES)
        for angle, far in zip(ANGLES, reach, strict=True):
            if far == inf:
                continue
            edge = evader + far * np.array([np.cos(angle), np.sin(angle)])
            nearest = np.hypot(*(pursuers - edge).T).min()
            assert far == pytest.approx(ratio * nearest, rel=1e-9)


def test_at_equal_speeds_the_cell_is_bounded_inside_the_hull_only() -> None:
    triangle = 2.0 * np.array(
        [[np.cos(a), np.sin(a)] for a in tau * np.arange(3) / 3]
    )
    inside = ApolloniusCell(ORIGIN, triangle)
    assert inside.is_bounded
    # The cell of the centre is the triangle of the three bisectors.
    assert inside.area(200_000) == pytest.approx(3.0 * sqrt(3.0), rel=1e-4)
    outside = ApolloniusCell(np.array([3.0, 0.0]), triangle)
    assert not outside.is_bounded and outside.area() == inf
    assert not ApolloniusCell(ORIGIN, triangle[:2]).is_bounded


def test_bad_positions_are_refused() -> None:
    with pytest.raises(PlanError, match="rows of x and y"):
        ApolloniusCell(ORIGIN, np.zeros((0, 2)))
    with pytest.raises(PlanError, match="apart from the evader"):
        ApolloniusCell(ORIGIN, np.zeros((1, 2)))
    with pytest.raises(PlanError, match="ratio"):
        ApolloniusCell(ORIGIN, np.ones((1, 2)), 1.5)
