"""Test ray-cast cameras in front of walls and slopes."""

from dataclasses import replace
from math import cos, radians, sqrt

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.perception.camera_model import CameraModel
from stepaside.robots.head import Mount
from stepaside.sim.camera_settings import DepthSettings
from stepaside.sim.ranging import RayCaster
from stepaside.sim.sensor_suite import cast_depths

CAMERA = CameraModel.of_field_of_view(40, 30, radians(58.0), radians(45.0))
AHEAD = Mount((0.1, 0.0, 0.0))
CLEAN = DepthSettings(noise=0.0, missing=0.0, step=1e-5)


def generator() -> np.random.Generator:
    return np.random.default_rng(4)


def wall(away: float, top: float = 3.0, half: float = 5.0) -> str:
    """A wall whose face is so far ahead of the body."""
    return (
        f'<geom name="wall" type="box" pos="{away + 0.5} 0 0"'
        f' size="0.5 {half} {top}" rgba="1 0 0 1"/>'
    )


def cast(
    things: str, rays: Array, mount: Mount = AHEAD, at: str = 'pos="0 0 0.5"'
) -> tuple[mujoco.MjModel, RayCaster]:
    """Return a ray caster on a body with a shell above a floor."""
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><geom name="floor" type="plane" size="9 9 1"/>'
        f'<body name="eye" {at}><geom size="0.3" group="1"/></body>'
        f"{things}</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, RayCaster(model, data, "eye", mount, rays)


def test_a_ray_goes_from_its_mount_on_a_turned_body() -> None:
    """The body looks to the left; the mount is aside and looks down."""
    mount = Mount((0.1, -0.2, 0.05), pitch=30.0)
    at = 'pos="1 2 0.5" quat="0.70710678 0 0 0.70710678"'
    _, caster = cast(
        "", np.array([[2.0, 0.0, 0.0], [3.0, 0.0, 2.0]]), mount, at
    )
    caster.cast(10.0)
    np.testing.assert_allclose(caster.origin, (1.2, 2.1, 0.55), atol=1e-7)
    ahead = (0.0, cos(radians(30)), -0.5)
    np.testing.assert_allclose(caster.directions[0], ahead, atol=1e-7)
    assert caster.distances.tolist() == pytest.approx([1.1, -1.0])
    assert caster.geoms.tolist() == [0, -1]
    assert caster.slants[0] == pytest.approx(0.5)
    np.testing.assert_allclose(caster.along, (0.5, 1.0 / sqrt(13.0)))


def depths(
    things: str,
    settings: DepthSettings,
    mount: Mount = AHEAD,
    at: str = 'pos="0 0 0.5"',
) -> np.ndarray:
    _, caster = cast(things, CAMERA.rays().reshape(-1, 3), mount, at)
    return cast_depths(caster, CAMERA, settings, generator())


def test_depth_is_along_the_axis_and_not_along_the_ray() -> None:
    """A wall across the axis is as deep everywhere."""
    image = depths(wall(1.6), CLEAN)
    assert image.shape == (30, 40)
    down = -CAMERA.rays()[..., 2]
    clear = 0.5 / np.maximum(down, 1e-9) > 1.5
    np.testing.assert_allclose(image[clear], 1.5, atol=1e-4)
    floor = ~clear
    np.testing.assert_allclose(image[floor], (0.5 / down)[floor], atol=1e-4)


@pytest.mark.parametrize(
    ("face", "seen"),
    [(0.85, False), (0.95, True), (3.55, True), (3.65, False)],
)
def test_depth_comes_back_from_within_the_limits(
    face: float, seen: bool
) -> None:
    """They hold from the mount, 0.1 m ahead of the body."""
    image = depths(wall(face), CLEAN)
    assert (image[2] > 0.0).all() if seen else (image[2] == 0.0).all()


def test_the_floor_is_seen_far_from_the_origin_of_the_world() -> None:
    """The floor is 18 m wide."""
    near, far = (
        depths("", CLEAN, at=f'pos="{x} 0 0.5"') for x in ("0.0", "-8.5")
    )
    assert (near > 0.0).any()
    np.testing.assert_allclose(far, near, atol=1e-4)


def test_depth_noise_and_quanta_grow_with_the_square() -> None:
    for face in (1.1, 2.6):
        away = face - 0.1
        noisy = depths(wall(face), replace(CLEAN, noise=0.004))[:12]
        assert noisy.std() == pytest.approx(0.004 * away**2, rel=0.1)
        assert noisy.mean() == pytest.approx(away, abs=0.001 * away**2)
        steps = replace(CLEAN, noise=0.004, step=0.003)
        levels = np.unique(depths(wall(face), steps)[:12])
        assert np.diff(levels).min() == pytest.approx(
            0.003 * away**2, rel=0.02
        )


def test_the_shadow_of_an_edge_is_dark_in_the_image() -> None:
    post = '<geom type="box" pos="1.1 0 0.5" size="0.05 0.1 0.5"/>'
    image = depths(wall(2.1) + post, CLEAN)[10]
    near = np.flatnonzero(np.abs(image - 0.95) < 0.01)
    dark = np.flatnonzero(image == 0.0)
    assert dark.tolist() == [near[0] - 1]
