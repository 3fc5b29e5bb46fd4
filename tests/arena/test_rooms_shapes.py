"""Test discs, polygons and distances between them."""

from math import cos, nan, pi, sin

import numpy as np
import pytest

from stepaside.arena import (
    NO_OBSTACLES,
    Box,
    Disc,
    Obstacle,
    ObstacleSet,
    Polygon,
    clearance_between,
)
from stepaside.core.errors import ConfigurationError

SQUARE = Box(0.0, 0.0, 2.0, 2.0)
SHAPES = (
    Disc(0.3, -0.2, 0.4),
    Box(-0.8, 0.6, 0.8, 0.3, 0.7),
    Polygon(((0.5, 0.4), (1.3, 0.6), (0.8, 1.3))),
    Disc(-0.7, -0.9, 0.2),
)


def outline(shape: Obstacle, count: int = 400) -> np.ndarray:
    """Return points along the edge. Shape (m * count, 2)."""
    fraction = np.linspace(0.0, 1.0, count, endpoint=False)[:, None]
    ends = np.roll(shape.outline, -1, axis=0)
    pairs = zip(shape.outline, ends, strict=True)
    return np.concatenate([a + fraction * (b - a) for a, b in pairs])


@pytest.mark.parametrize(
    "shape",
    [
        Disc(0.3, -0.2, 0.4),
        Box(0.2, 0.1, 0.8, 0.3, 0.7),
        Polygon(((0.0, 0.0), (1.0, 0.2), (0.3, 0.9))),
    ],
)
def test_clearance_has_a_gradient_of_one(shape: Obstacle) -> None:
    """By finite differences at random points."""
    points = np.random.default_rng(1).uniform(-2.0, 2.0, (500, 2))
    small = 1e-6
    slopes = [
        (shape.clearance(points + d) - shape.clearance(points - d))
        / (2.0 * small)
        for d in (np.array([small, 0.0]), np.array([0.0, small]))
    ]
    np.testing.assert_allclose(np.hypot(*slopes), 1.0, atol=1e-6)


def test_clearance_between_boxes_is_that_of_their_outlines() -> None:
    random = np.random.default_rng(2)
    for _ in range(30):
        x, y, turn = random.uniform(-2.0, 2.0, 3)
        other = Box(x, y, 0.7, 0.3, turn)
        found = clearance_between(SQUARE, other)
        nearest = SQUARE.clearance(outline(other)).min()
        if found > 0.0:
            assert found == pytest.approx(nearest, abs=3e-3)
        else:
            assert nearest <= 1e-12
        assert found == pytest.approx(clearance_between(other, SQUARE))


def test_overlap_is_minus_the_penetration_depth() -> None:
    other = Box(1.4, 0.2, 1.0, 1.0)
    assert clearance_between(SQUARE, other) == pytest.approx(-0.1)
    assert clearance_between(
        SQUARE, Box(1.4 + 0.1001, 0.2, 1.0, 1.0)
    ) == pytest.approx(1e-4)
    for x, out in ((1.2, -0.1), (0.8, -0.5)):
        disc = Disc(x, 0.0, 0.3)
        assert clearance_between(SQUARE, disc) == pytest.approx(out)
        assert clearance_between(disc, SQUARE) == pytest.approx(out)
    assert clearance_between(disc, Disc(0.8, 0.4, 0.2)) == pytest.approx(-0.1)


@pytest.mark.parametrize("shape", [Disc(0.0, 0.0, 1.0), SQUARE])
def test_segment_intersects_a_shape_that_contains_one_of_its_points(
    shape: Obstacle,
) -> None:
    random = np.random.default_rng(3)
    starts = random.uniform(-3.0, 3.0, (300, 2))
    ends = random.uniform(-3.0, 3.0, (300, 2))
    fraction = np.linspace(0.0, 1.0, 2001)[:, None]
    nearest = np.array(
        [
            shape.clearance(a + fraction * (b - a)).min()
            for a, b in zip(starts, ends, strict=True)
        ]
    )
    clear = np.abs(nearest) > 0.01  # decidable by samples
    found = ~ObstacleSet((shape,)).segments_keep_clear(0.0, starts, ends)
    assert 50 < found[clear].sum() < 250
    np.testing.assert_array_equal(found[clear], nearest[clear] < 0.0)


PENTAGRAM = tuple((cos(4 * pi * i / 5), sin(4 * pi * i / 5)) for i in range(5))


@pytest.mark.parametrize(
    ("corners", "rule"),
    [
        (((0, 0), (1, 1), (1, 0), (0, 1)), "must not cross itself"),
        (PENTAGRAM, "must not cross itself"),
        (((0, 0), (1, 0), (0.2, 0.2), (0, 1)), "must be convex"),
        (((0, 0), (1, 0)), "corners must have 3 to 64 entries"),
        (((0, 0), (1, 0), (2, 0)), "must"),
        (
            ((0, 0), (1, 0), (nan, 1)),
            r"corners 3 1 must lie .* \[m\], got nan",
        ),
        (((0, 0), (1, 0), (1, 1, 1)), "corners 3 must have 2 entries"),
        (((0, 0), (1, 0), (1, "1")), r"corners 3 2 .* \[m\], got '1'"),
        (((0, 0), (1, 0), (1, 1e9)), r"must lie in \[-1000, 1000\] \[m\]"),
        (((0, 0), (1, 0), (1, 1e-5)), "edges >= 0.001"),
    ],
)
def test_invalid_polygon_is_refused(corners: object, rule: str) -> None:
    with pytest.raises(ConfigurationError, match=rule) as caught:
        Polygon(corners)  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)


def test_direction_out_is_the_gradient_of_the_clearance() -> None:
    """By finite differences."""
    points = np.random.default_rng(6).uniform(-1.5, 1.5, (200, 2))
    known, small = ObstacleSet(SHAPES), 1e-6
    slopes = [
        (known.clearances(points + d) - known.clearances(points - d))
        / (2.0 * small)
        for d in (np.array([small, 0.0]), np.array([0.0, small]))
    ]
    np.testing.assert_allclose(
        known.directions_out(points), np.stack(slopes, axis=-1), atol=1e-5
    )


def test_set_agrees_with_each_of_its_shapes() -> None:
    points = np.random.default_rng(7).uniform(-2.0, 2.0, (300, 2))
    starts, ends = points[:150], points[150:]
    known = ObstacleSet(SHAPES)
    alone = [ObstacleSet((shape,)) for shape in SHAPES]
    each = np.stack([shape.clearance(points) for shape in SHAPES], axis=1)
    np.testing.assert_allclose(known.clearances(points), each, atol=1e-12)
    np.testing.assert_allclose(known.clearance(points), each.min(axis=1))
    np.testing.assert_array_equal(
        known.segments_keep_clear(0.0, starts, ends),
        np.all(
            [s.segments_keep_clear(0.0, starts, ends) for s in alone], axis=0
        ),
    )
    assert NO_OBSTACLES.clearance(points).min() == np.inf
    assert NO_OBSTACLES.segments_keep_clear(0.0, starts, ends).all()


@pytest.mark.parametrize("radius", [0.0, 0.2])
def test_segment_keeps_clear_if_all_its_points_do(radius: float) -> None:
    random = np.random.default_rng(8)
    known = ObstacleSet(SHAPES)
    points = random.uniform(-2.0, 2.0, (400, 2))
    points = points[known.clearance(points) > radius + 1e-3]
    start, ends = points[0], points[1:]
    fraction = np.linspace(0.0, 1.0, 2001)[:, None]
    least = np.array(
        [known.clearance(start + fraction * (e - start)).min() for e in ends]
    )
    decided = np.abs(least - radius) > 0.01
    found = known.segments_keep_clear(radius, start[None], ends)
    assert 20 < found[decided].sum() < decided.sum() - 20
    np.testing.assert_array_equal(found[decided], least[decided] > radius)
