"""Test walls, objects and camera housings of a room."""

import mujoco
import numpy as np
import pytest

from stepaside.robots.description import load_robot
from stepaside.robots.head import load_head
from stepaside.sim.camera_settings import RoomObject, SceneSettings
from stepaside.sim.room_furnishing import LOWER, furnisher

HEAD = load_head(load_robot("nao"))


def furnished(
    room: SceneSettings, *, lower: tuple[str, ...] = ()
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="me/head", pos=[1.0, 2.0, 0.5]).add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.05, 0, 0], mass=0.6
    )
    furnisher(room, HEAD, walls=room.walls, housings=["me"], lower=lower)(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, data


def test_walls_enclose_the_room_at_their_distance() -> None:
    model, data = furnished(SceneSettings(walls=3.0))
    for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        wall = model.geom(f"wall {x} {y}")
        np.testing.assert_allclose(wall.pos, (3.0 * x, 3.0 * y, 1.2))
        thick = [0.05 if c else 3.0 for c in (x, y)]
        np.testing.assert_allclose(wall.size, (*thick, 1.2))
        assert (wall.contype[0], wall.conaffinity[0]) == (1, 0)
        assert model.mat(wall.matid[0]).name == "wall"
        away = mujoco.mj_ray(
            model,
            data,
            np.zeros(3) + (0, 0, 1.0),
            np.array([x, y, 0.0]),
            None,
            1,
            -1,
            np.zeros(1, dtype=np.int32),
        )
        assert away == pytest.approx(2.95)
    material = model.mat("wall")
    assert material.texrepeat.tolist() == [1.0, 1.0]
    assert material.texuniform[0] == 1
    role = mujoco.mjtTextureRole.mjTEXROLE_RGB
    assert model.tex(material.texid[role]).name == "wall"
    assert model.tex("wall").width[0] == 128 == model.tex("wall").height[0]


def test_walls_are_pale_and_checked() -> None:
    """Two tones that differ from trim."""
    model, _ = furnished(SceneSettings(walls=3.0))
    texture = model.tex("wall")
    start = int(texture.adr[0])
    pixels = model.tex_data[start : start + 3 * 128 * 128].reshape(-1, 3)
    tones = np.unique(pixels, axis=0) / 255.0
    assert len(tones) == 2
    for tone in tones:
        assert 0.7 < tone.max() < 0.8
        assert tone.min() > 0.9 * tone.max()


def test_zero_walls_add_none() -> None:
    model, _ = furnished(SceneSettings(walls=0.0))
    names = [model.geom(i).name for i in range(model.ngeom)]
    assert not any("wall" in name for name in names)
    assert model.ngeom == 2  # the head and what it wears


@pytest.mark.parametrize(
    ("kind", "channel"), [("red box", 0), ("blue box", 2)]
)
def test_a_box_is_forty_centimeters_high_and_coloured(
    kind: str, channel: int
) -> None:
    model, data = furnished(SceneSettings(0.0, [RoomObject(kind, 0.5, -0.7)]))
    body = model.body("thing 0")
    (box,) = np.flatnonzero(model.geom_bodyid == body.id)
    np.testing.assert_allclose(data.geom_xpos[box], (0.5, -0.7, 0.2))
    np.testing.assert_allclose(model.geom_size[box], (0.12, 0.12, 0.2))
    colour = model.geom_rgba[box]
    assert colour[channel] > 1.8 * np.delete(colour[:3], channel).max()
    assert 0.6 < colour[channel] <= 1.0 == colour[3]
    assert (model.geom_contype[box], model.geom_conaffinity[box]) == (1, 0)


def test_a_white_figure_is_as_tall_as_a_robot_and_symmetric() -> None:
    thing = RoomObject("white figure", 1.0, 2.0)
    model, data = furnished(SceneSettings(0.0, [thing]))
    parts = np.flatnonzero(model.geom_bodyid == model.body("thing 0").id)
    places = data.geom_xpos[parts] - (1.0, 2.0, 0.0)
    sizes = model.geom_size[parts]
    assert len(parts) == 6
    top = (places + sizes)[:, 2].max()
    assert top == pytest.approx(0.574, abs=0.02)  # of a NAO
    assert (places - sizes)[:, 2].min() == pytest.approx(0.0, abs=0.015)
    breadth = (places + sizes)[:, 1].max()
    assert 2.0 * breadth == pytest.approx(0.311, abs=0.02)
    mirrored = {(*p, *s) for p, s in zip(places, sizes, strict=True)}
    for p, s in zip(places, sizes, strict=True):
        assert any(
            np.allclose((p[0], -p[1], p[2], *s), other) for other in mirrored
        )
    # Its parts touch: from the feet to the crown nothing is open.
    for level in np.arange(0.02, 0.55, 0.01):
        inside = np.abs(places[:, 2] - level) < sizes[:, 2]
        assert inside.any()
    # Head and trunk are as broad and deep as those of a NAO.
    np.testing.assert_allclose(2 * sizes[0], (0.124, 0.132, 0.128))
    np.testing.assert_allclose(2 * sizes[1], (0.12, 0.16, 0.2))
    assert places[0, 2] - places[1, 2] == pytest.approx(0.15)
    # Arms and legs are longer than broad.
    assert (sizes[2:, 2] > 2.9 * sizes[2:, 0]).all()
    np.testing.assert_allclose(sizes[2:, 0], sizes[2:, 1])
    assert (model.geom_rgba[parts] > 0.9).all()
    assert (model.geom_contype[parts] == 1).all()
    assert (model.geom_conaffinity[parts] == 0).all()


def test_objects_are_at_their_positions() -> None:
    things = [
        RoomObject("red box", 1.0, 0.0),
        RoomObject("white figure", -1.0, 0.5),
    ]
    model, _ = furnished(SceneSettings(0.0, things))
    for index, thing in enumerate(things):
        place = model.body(f"thing {index}").pos
        np.testing.assert_allclose(place, (thing.x, thing.y, 0.0))


def test_the_housing_is_massless_and_behind_the_lens() -> None:
    model, data = furnished(SceneSettings(0.0))
    head = model.body("me/head").id
    _, housing = np.flatnonzero(model.geom_bodyid == head)
    assert model.body_mass[head] == pytest.approx(0.6)
    depth, width, height = HEAD.housings[0]
    np.testing.assert_allclose(
        model.geom_size[housing], (depth / 2, width / 2, height / 2)
    )
    window = data.geom_xpos[housing] + (depth / 2, 0.0, 0.0)
    np.testing.assert_allclose(
        window, HEAD.depth[0].position_in_body + (1.0, 2.0, 0.5)
    )
    assert model.geom_group[housing] == 2
    assert model.geom_contype[housing] == 0 == model.geom_conaffinity[housing]
    black = (0.1, 0.1, 0.1, 1.0)
    np.testing.assert_allclose(model.geom_rgba[housing], black, rtol=1e-6)


def test_the_bottom_camera_has_the_axes_of_its_mount() -> None:
    """It looks along -z with x to the right, and exists on request only."""
    model, data = furnished(SceneSettings(walls=0.0), lower=("me",))
    mujoco.mj_camlight(model, data)
    camera, mount = model.camera(f"me/{LOWER}").id, HEAD.bottom
    assert mount is not None
    place = np.array([1.0, 2.0, 0.5]) + mount.position_in_body
    np.testing.assert_allclose(data.cam_xpos[camera], place, atol=1e-9)
    right, up, back = data.cam_xmat[camera].reshape(3, 3).T
    forward, left, upward = mount.axes_in_body.T
    np.testing.assert_allclose(back, -forward, atol=1e-9)
    np.testing.assert_allclose(right, -left, atol=1e-9)
    np.testing.assert_allclose(up, upward, atol=1e-9)
    assert forward[2] == pytest.approx(-np.sin(np.radians(39.7)))
    assert furnished(SceneSettings(walls=0.0))[0].ncam == 0
