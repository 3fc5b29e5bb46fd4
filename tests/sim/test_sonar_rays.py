"""Test ray-cast sonars in front of walls and slopes."""

from dataclasses import replace
from math import radians

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.robots.head import Mount
from stepaside.sim.camera_settings import SonarSettings
from stepaside.sim.ray_casting import RayCaster, SonarCaster, cone

AHEAD = Mount(np.array([0.1, 0.0, 0.0]), np.eye(3))
QUIET = SonarSettings(noise=0.0)


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


def hear(
    things: str, settings: SonarSettings = QUIET, at: str = 'pos="0 0 0.5"'
) -> float | None:
    _, caster = cast(things, cone(settings.cone), AHEAD, at)
    return SonarCaster(caster, settings, generator()).listen()


def test_a_sonar_measures_the_nearest_object_not_the_floor() -> None:
    post = '<geom type="box" pos="0.75 0.1 0.5" size="0.1 0.1 0.5"/>'
    for things in (wall(0.8) + post, post):
        heard = hear(things)
        assert heard is not None and 0.55 <= heard <= 0.60
    assert hear("") is None


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_floor_and_ceiling_give_no_echo(sign: float) -> None:
    """Also for a sonar that is pitched; a slope gives an echo."""
    lid = '<geom type="box" pos="0 0 1.1" size="2 2 0.1" euler="0 {} 0"/>'
    up = np.cos(-sign * np.pi / 6), np.sin(-sign * np.pi / 6)
    at = f'pos="0 0 0.5" quat="{up[0]} 0 {up[1]} 0"'
    assert hear(lid.format(0), at=at) is None
    assert (hear(lid.format(35), at=at) is not None) is (sign > 0.0)


@pytest.mark.parametrize(
    ("face", "echo"), [(0.2, 0.2), (0.25, 0.2), (0.6, 0.5), (0.95, None)]
)
def test_echoes_are_clipped_to_the_range(
    face: float, echo: float | None
) -> None:
    """The rays next to the axis are a little longer than it."""
    heard = hear(wall(face))
    if echo is None:
        assert heard is None
    else:
        assert heard is not None
        assert echo <= heard <= 1.03 * echo + 0.005
        assert round(heard / 0.01) == pytest.approx(heard / 0.01)


def test_a_sonar_has_its_far_limit() -> None:
    far = replace(QUIET, far=1.5)
    assert hear(wall(1.35), far) is not None
    assert hear(wall(1.65), far) is None
    coarse = replace(QUIET, far=1.5, step=0.3)
    assert hear(wall(1.0), coarse) == pytest.approx(0.9)


def test_sonar_noise_has_the_set_deviation() -> None:
    settings = replace(QUIET, noise=0.02, step=1e-4)
    _, caster = cast(wall(0.6), cone(settings.cone))
    sonar = SonarCaster(caster, settings, generator())
    heard = np.array([sonar.listen() for _ in range(500)], dtype=float)
    assert heard.std() == pytest.approx(0.02, rel=0.1)
    quiet = SonarCaster(caster, replace(settings, noise=0.0), generator())
    assert heard.mean() == pytest.approx(quiet.listen(), abs=0.003)


@pytest.mark.parametrize(("angle", "heard"), [(57.0, True), (63.0, False)])
def test_oblique_surfaces_give_no_echo(angle: float, heard: bool) -> None:
    """A plate turned about the vertical, in a narrow cone."""
    leaf = (
        '<geom type="box" pos="0.6 0 0.5" size="0.001 0.3 0.5" '
        f'euler="0 0 {angle}"/>'
    )
    narrow = replace(QUIET, cone=0.06)
    assert (hear(leaf, narrow) is not None) is heard


def test_a_cone_is_filled_by_a_grid_of_rays() -> None:
    """Of six by six those within it; the outermost are not on its rim."""
    rays = cone(radians(60.0))
    angles = np.degrees(np.arctan(np.hypot(rays[:, 1], rays[:, 2])))
    assert len(rays) == 16 and (rays[:, 0] == 1.0).all()
    assert 26.0 < angles.max() < 30.0
    np.testing.assert_allclose(rays.mean(axis=0), (1, 0, 0), atol=1e-12)
    assert np.unique(np.round(rays[:, 1:], 9), axis=0).shape == (16, 2)
