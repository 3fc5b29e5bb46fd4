"""Test that geoms outside a cone of view are hidden, and no others."""

from math import radians

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.sim.view_cone import geoms_in_cone

EYE = np.array([0.1, -0.2, 0.5])


def balls(places: Array, radii: Array) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return balls above a floor, which is geom 0."""
    text = "".join(
        f'<geom size="{r}" pos="{x} {y} {z}"/>'
        for (x, y, z), r in zip(places.tolist(), radii.tolist(), strict=True)
    )
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody>"
        f'<geom type="plane" size="9 9 1"/>{text}</worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, data


@pytest.mark.parametrize("half_angle", [radians(20.0), radians(40.0)])
def test_what_any_ray_of_the_cone_hits_is_shown(half_angle: float) -> None:
    """Each ball alone before a dense cone of rays."""
    random = np.random.default_rng(3)
    places = EYE + random.normal(size=(200, 3))
    radii = random.uniform(0.02, 0.3, 200)
    model, data = balls(places, radii)
    axis = np.array([0.6, 0.64, -0.48])
    directions = random.normal(size=(20000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    inside = directions[directions @ axis > np.cos(half_angle)]
    before = model.geom_group.copy()
    with geoms_in_cone(model, data, EYE, axis, half_angle):
        shown = model.geom_group == before
    np.testing.assert_array_equal(model.geom_group, before)
    along = (places - EYE) @ inside.T
    squares = np.square(places - EYE).sum(axis=1)[:, None]
    misses = np.sqrt(np.maximum(squares - along**2, 0.0))
    hit = ((misses < radii[:, None]) & (along > 0.0)).any(axis=1)
    hit |= squares[:, 0] < radii**2
    assert shown[0]  # the floor
    assert shown[1:][hit].all()
    assert 20 < (~shown).sum() < 200 - hit.sum() + 1
