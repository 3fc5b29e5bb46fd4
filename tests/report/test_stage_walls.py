"""Walls hide no robot from outside, and labels are above their players."""

import mujoco
import numpy as np
import pytest

from stepaside.arena import Door, Room
from stepaside.core.poses import Array
from stepaside.report.visual_geoms import VisualGeom, visual_geoms_of
from stepaside.sim.room_furnishing import add_solids

SHAPES = [(3.0, 3.0), (2.0, 8.0), (9.0, 1.5)]
DOORS = (Door("east", 0.2, 0.6), Door("south", -0.3, 0.7))


def room_model(room: Room) -> mujoco.MjModel:
    """Return a model of only a room."""
    spec = mujoco.MjSpec()
    add_solids(spec, room)
    return spec.compile()


def triangles_of(part: VisualGeom, model: mujoco.MjModel) -> Array:
    """Return the triangles of a geom in the world. Shape (n, 3, 3)."""
    assert part.mesh is not None
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, part.quaternion)
    vertices = part.mesh.vertices @ rotation.reshape(3, 3).T
    in_world: Array = vertices + part.position + model.body_pos[part.body]
    return in_world[part.mesh.faces]


def hides(triangles: Array, eye: Array, point: Array) -> bool:
    """Return whether the front of a triangle lies between eye and point."""
    for a, b, c in triangles:
        normal = np.cross(b - a, c - a)
        if normal @ (eye - a) <= 0.0:
            continue  # back faces are not drawn
        matrix = np.column_stack([b - a, c - a, eye - point])
        if abs(np.linalg.det(matrix)) < 1e-12:
            continue
        u, v, t = np.linalg.solve(matrix, eye - a)
        if u >= 0.0 and v >= 0.0 and u + v <= 1.0 and 0.0 < t < 1.0 - 1e-6:
            return True
    return False


@pytest.mark.parametrize("doors", [(), DOORS])
@pytest.mark.parametrize("shape", SHAPES)
def test_no_wall_hides_the_inside_of_the_room_from_outside(
    shape: tuple[float, float], doors: tuple[Door, ...]
) -> None:
    width, depth = shape
    room = Room(width=width, depth=depth, doors=doors)
    model = room_model(room)
    walls = [g for g in visual_geoms_of(model) if g.kind == "mesh"]
    assert len(walls) == len(room.walls) == 4 + len(doors)
    all_faces = np.concatenate([triangles_of(p, model) for p in walls])
    random = np.random.default_rng(3)
    half = 0.5 * np.array([width, depth])
    for _ in range(60):
        angle = random.uniform(0.0, 2.0 * np.pi)
        away = float(np.hypot(*half)) + random.uniform(0.3, 4.0)
        high = random.uniform(0.1, 3.0)
        eye = np.array([away * np.cos(angle), away * np.sin(angle), high])
        spot = random.uniform(-0.95, 0.95, 2) * half
        point = np.array([*spot, random.uniform(0.05, 0.6)])
        assert not hides(all_faces, eye, point)
    # From inside, all walls are drawn and hide points beyond them.
    eye = np.array([0.0, 0.0, 0.3])
    for wall in room.walls:
        beyond = np.array([*(1.5 * wall.points.mean(axis=0)), 0.3])
        assert hides(all_faces, eye, beyond)
