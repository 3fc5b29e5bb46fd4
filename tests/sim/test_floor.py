"""Test the floor: slope, unevenness and random heights."""

from math import cos, pi, sin
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.core.random_streams import named_generator
from stepaside.sim.floor import add_floor, tilt_gravity
from stepaside.sim.physics_settings import PhysicsSettings


def floor(seed: int = 1, **changes: Any) -> mujoco.MjModel:
    spec = mujoco.MjSpec()
    physics = PhysicsSettings(**changes)
    tilt_gravity(spec, physics)
    add_floor(spec, physics, named_generator(seed, "floor"))
    return spec.compile()


@pytest.mark.parametrize("down", [0.0, 0.7, pi / 2, -2.0])
@pytest.mark.parametrize("slope", [0.0, 0.1, 0.4])
def test_gravity_pulls_down_the_slope(slope: float, down: float) -> None:
    x, y, z = floor(slope=slope, slope_direction=down).opt.gravity
    along = 9.81 * sin(slope)
    assert x == pytest.approx(along * cos(down), abs=1e-12)
    assert y == pytest.approx(along * sin(down), abs=1e-12)
    assert z == pytest.approx(-9.81 * cos(slope))


def test_an_even_floor_is_a_plane_with_the_friction_asked_for() -> None:
    model = floor(friction=0.63)
    assert model.nhfield == 0
    assert model.geom_type[0] == mujoco.mjtGeom.mjGEOM_PLANE
    np.testing.assert_allclose(model.geom_friction[0], [0.63, 0.005, 0.0001])
    assert model.geom_contype[0] == 1 and model.geom_conaffinity[0] == 0
    np.testing.assert_array_equal(model.geom_pos[0], 0.0)


def heights(model: mujoco.MjModel) -> np.ndarray:
    rows, columns = model.hfield_nrow[0], model.hfield_ncol[0]
    grid: np.ndarray = model.hfield_data.reshape(rows, columns)
    return grid


def test_an_uneven_floor_has_the_set_grain_and_height() -> None:
    """8 m square; independent every 0.1 m, straight between."""
    model = floor(unevenness=0.004, friction=0.5)
    assert model.geom_type[0] == mujoco.mjtGeom.mjGEOM_HFIELD
    assert model.geom_dataid[0] == 0
    np.testing.assert_allclose(model.hfield_size[0], [4.0, 4.0, 0.004, 0.1])
    assert model.geom_friction[0, 0] == 0.5
    grid = heights(model)
    assert grid.shape == (162, 162)
    assert grid.min() >= 0.0 and grid.max() <= 1.0
    # Uniform heights, straight between: two thirds are left on each axis.
    assert grid.std() == pytest.approx(12**-0.5 * 2.0 / 3.0, rel=0.03)
    assert grid.mean() == pytest.approx(0.5, abs=0.02)
    near = np.corrcoef(grid[:-1].ravel(), grid[1:].ravel())[0, 1]
    far = np.corrcoef(grid[:-4].ravel(), grid[4:].ravel())[0, 1]
    assert near > 0.5 and abs(far) < 0.05
