"""Test the cameras that are added to robots in a room."""

import mujoco
import numpy as np
import pytest

from stepaside.robots.description import load_robot
from stepaside.robots.head import load_head
from stepaside.sim.camera_scene import add_scene, wall_distance
from stepaside.sim.camera_settings import SceneSettings

HEAD = load_head(load_robot("nao"))


def furnished(
    room: SceneSettings, *, wearers: tuple[str, ...] = ()
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="me/head", pos=[1.0, 2.0, 0.5]).add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.05, 0, 0], mass=0.6
    )
    add_scene(spec, room, "nao", walls=room.walls, wearers=wearers)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, data


def test_an_added_camera_has_the_axes_of_its_mount() -> None:
    """It looks along -z with x to the right, and exists on request only."""
    model, data = furnished(SceneSettings(walls=0.0), wearers=("me",))
    mujoco.mj_camlight(model, data)
    camera, mount = model.camera(f"me/{HEAD.camera}").id, HEAD.top
    place = np.array([1.0, 2.0, 0.5]) + mount.position_in_body
    np.testing.assert_allclose(data.cam_xpos[camera], place, atol=1e-9)
    right, up, back = data.cam_xmat[camera].reshape(3, 3).T
    forward, left, upward = mount.axes_in_body.T
    np.testing.assert_allclose(back, -forward, atol=1e-9)
    np.testing.assert_allclose(right, -left, atol=1e-9)
    np.testing.assert_allclose(up, upward, atol=1e-9)
    assert forward[2] == pytest.approx(-np.sin(np.radians(1.2)))
    assert furnished(SceneSettings(walls=0.0))[0].ncam == 0


def test_walls_keep_away_from_players_at_their_begin() -> None:
    """Those within a metre of a wall, or beyond, move it out of sight."""
    for y, walls in ((1.9, 3.0), (2.1, 5.6), (3.5, 7.0)):
        found = wall_distance(3.0, [(0.2, -y), (0.1, 0.3)])
        assert found == pytest.approx(walls)
    assert wall_distance(0.0, [(9.0, 9.0)]) == 0.0
