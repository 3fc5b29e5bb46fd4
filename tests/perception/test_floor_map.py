"""Test the occupancy grid from depth images."""

from math import pi

import numpy as np
import pytest

from stepaside.arena import Box, Disc, Obstacle
from stepaside.core.convex import signed_area
from stepaside.core.poses import Array
from stepaside.perception.camera_model import CameraModel, CameraPose
from stepaside.perception.floor_map import CELL, FloorMap, cover, wide_areas
from stepaside.perception.images import DepthImage

CAMERA = CameraModel.of_field_of_view(80, 60, 1.01, 0.785)
EYE, HIGH, FAR = 0.5, 0.6, 3.5


def view(
    solids: tuple[Obstacle, ...], place: tuple[float, float], heading: float
) -> tuple[DepthImage, Array, Array]:
    """Return a depth image of solids on a floor, by ray marching."""
    c, s = np.cos(heading), np.sin(heading)
    axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    rays = CAMERA.rays().reshape(-1, 3) @ axes.T
    start = np.array([*place, EYE])
    depths = np.zeros(len(rays))
    open_ = np.ones(len(rays), dtype=bool)
    for depth in np.arange(0.3, 2.8, 0.03):
        points = start + depth * rays
        inside = points[:, 2] < 0.0
        for solid in solids:
            near = open_ & (points[:, 2] < HIGH)
            inside[near] |= solid.clearance(points[near, :2]) < 0.0
        depths[inside & open_] = depth
        open_ &= ~inside
    depths[depths < 0.8] = 0.0
    image = DepthImage(
        0.0, CAMERA, depths.reshape(60, 80).astype(np.float32), 0.8, FAR
    )
    return image, start, axes


def view_at(
    solids: tuple[Obstacle, ...], heading: float
) -> tuple[DepthImage, CameraPose]:
    """Return a depth image from the origin, and the pose of its camera."""
    image, place, axes = view(solids, (0.0, 0.0), heading)
    return image, CameraPose(place, axes, (0.0, 0.0))


def looked(
    seen: FloorMap, solids: tuple[Obstacle, ...], times: int = 2
) -> FloorMap:
    views = [view(solids, (0.0, 0.0), h) for h in np.arange(-pi, pi, 0.7)]
    for _ in range(times):
        for image, place, axes in views:
            seen.take(image, CameraPose(place, axes, (0.0, 0.0)), None)
    return seen


def test_obstacles_are_mapped_at_their_positions() -> None:
    pillar, wall = Disc(1.2, 0.3, 0.15), Box(-1.4, 0.0, 0.1, 2.0)
    found = looked(FloorMap(), (pillar, wall)).occupied()
    near = np.array([[1.06, 0.25], [-1.34, 0.5], [-1.34, -0.5]])
    clearance = np.min([p.clearance(near) for p in found], axis=0)
    assert clearance.max() < 0.05  # all of it is on the map
    for polygon in found:
        off = np.minimum(
            pillar.clearance(polygon.points), wall.clearance(polygon.points)
        )
        assert off.max() < 1.5 * CELL  # and nothing else


def test_each_cell_is_whole_on_the_map() -> None:
    seen = looked(FloorMap(), (Disc(1.2, 0.3, 0.15),))
    polygons, cells = seen.occupied(), seen.occupied_cells()
    corners = 0.49 * CELL * np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    points = (cells[:, None] + corners).reshape(-1, 2)
    clearance = np.min([p.clearance(points) for p in polygons], axis=0)
    assert clearance.max() <= 1e-9


def test_cells_of_a_moved_obstacle_are_cleared() -> None:
    seen = looked(FloorMap(), (Disc(1.2, 0.3, 0.15),), times=4)
    assert seen.occupied()
    looked(seen, (), times=14)
    assert not seen.occupied()


def test_the_opponent_is_not_mapped() -> None:
    seen = FloorMap()
    body = (Disc(1.2, 0.0, 0.12),)
    for _ in range(4):
        seen.take(*view_at(body, 0.0), (1.25, 0.05))
    assert not seen.occupied()


def test_unknown_floor_differs_from_free_floor() -> None:
    seen = FloorMap()
    for _ in range(2):
        seen.take(*view_at((), 0.0), None)
    hidden = seen.unknown((0.0, 0.0))
    ahead, behind = np.array([[0.8, 0.0]]), np.array([[-0.83, 0.02]])
    assert min(float(p.clearance(ahead)[0]) for p in hidden) > 0.0
    assert min(float(p.clearance(behind)[0]) for p in hidden) < 0.0
    assert not seen.occupied()


def test_floor_too_near_to_be_measured_stays_unknown() -> None:
    """It also hides the floor behind, so no ray frees the floor below."""
    near = Disc(0.55, 0.0, 0.15)
    seen = looked(FloorMap(), (near,))
    assert not seen.occupied()
    hidden = seen.unknown((0.0, 0.0))
    inside = np.array([[0.45, 0.0], [0.55, 0.0], [0.6, 0.1], [0.6, -0.1]])
    clearance = np.min([p.clearance(inside) for p in hidden], axis=0)
    assert clearance.max() <= 0.0
    aside = np.array([[0.6, 0.6], [-0.6, 0.0], [0.0, -0.6]])
    clearance = np.min([p.clearance(aside) for p in hidden], axis=0)
    assert clearance.min() > 0.2


def test_a_second_view_leaves_only_the_obstacle() -> None:
    near, seen = Disc(0.55, 0.0, 0.15), FloorMap()
    for place in ((0.0, 0.0), (0.3, -0.8), (0.3, 0.8)):
        for heading in np.arange(-pi, pi, 0.5):
            image, eye, axes = view((near,), place, heading)
            for _ in range(2):
                seen.take(image, CameraPose(eye, axes, place), None)
    found = seen.unknown((0.0, 0.0)) + seen.occupied()
    assert found
    for polygon in found:
        assert near.clearance(polygon.points).max() < 0.16


def test_hits_on_the_opponent_are_erased_when_it_is_recognised() -> None:
    """It was mapped as an obstacle before."""
    seen, body = FloorMap(), (Disc(1.2, 0.0, 0.12),)
    for _ in range(4):
        seen.take(*view_at(body, 0.0), None)
    assert seen.occupied()
    seen.take(*view_at(body, 0.0), (1.2, 0.0))
    assert not seen.occupied()


@pytest.mark.parametrize("heading", [0.0, 0.3, pi / 4])
def test_a_corner_of_two_walls_becomes_few_polygons(heading: float) -> None:
    c, s = np.cos(heading), np.sin(heading)
    x, y = np.meshgrid(np.arange(-2, 2, CELL) + 0.01, np.arange(-2, 2, CELL))
    grid = np.stack([x.ravel(), y.ravel()], axis=-1)
    u, v = grid @ [c, s], grid @ [-s, c]
    walls = (abs(u) < 0.06) & (v > 0.0) & (v < 1.2)
    walls |= (abs(v) < 0.06) & (u > 0.0) & (u < 1.2)
    cells = grid[walls]
    found = cover(cells, CELL)
    assert len(found) <= 12
    clearance = np.min([p.clearance(cells) for p in found], axis=0)
    assert clearance.max() <= 1e-9
    assert (
        sum(signed_area(p.points) for p in found) < 2.5 * len(cells) * CELL**2
    )


def test_the_rim_of_what_is_unseen_is_unseen() -> None:
    """Round things are not shorn; strips are noise."""
    hidden = np.zeros((12, 12), dtype=np.bool_)
    hidden[3:7, 4:8] = True
    hidden[2, 5:7] = hidden[7, 5:7] = hidden[4:6, 3] = hidden[4:6, 8] = True
    assert (wide_areas(hidden) == hidden).all()
    strip = np.zeros((12, 12), dtype=np.bool_)
    strip[4:6] = True
    assert not wide_areas(strip).any()
