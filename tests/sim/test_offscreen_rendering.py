"""Test the choice of a renderer."""

import os
from collections.abc import Iterator

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.sim import offscreen_rendering as graphics
from stepaside.sim.offscreen_rendering import (
    BACKENDS,
    OffscreenRenderer,
    choose_renderer,
)


@pytest.fixture
def works(monkeypatch: pytest.MonkeyPatch) -> Iterator[set[str]]:
    """Return the set of working backends, which a test fills."""
    found: set[str] = set()
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(graphics, "_works", found.__contains__)
    yield found


def test_egl_is_preferred_to_osmesa_and_rays(works: set[str]) -> None:
    assert choose_renderer() == "raycast"
    works.add("osmesa")
    assert choose_renderer() == "osmesa"
    works.add("egl")
    assert choose_renderer() == "egl"


def test_a_requested_renderer_is_used_or_refused(
    works: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    works |= {"egl"}
    assert choose_renderer("egl") == "egl"
    assert choose_renderer("raycast") == "raycast"
    with pytest.raises(ConfigurationError, match="osmesa does not work"):
        choose_renderer("osmesa")


SCENE = """<mujoco><visual><headlight ambient="1 1 1" diffuse="0 0 0"
specular="0 0 0"/></visual><worldbody>
<geom name="floor" type="plane" size="4 4 0.01" rgba="0.5 0.5 0.5 1"/>
<geom type="box" size="0.2 0.2 0.2" pos="2 0.5 1.3" rgba="1 0 0 1"/>
<geom type="box" size="0.2 0.2 0.2" pos="-2 0 1" rgba="0 0 1 1"/>
<camera name="ahead" pos="0 0 1" xyaxes="0 -1 0 0 0 1" fovy="60"/>
<camera name="back" pos="0 0 1" xyaxes="0 1 0 0 0 1" fovy="60"/>
</worldbody></mujoco>"""


def test_a_rendered_image_is_upright(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ahead a red box up on the left, behind a blue one in the middle."""
    renderer = choose_renderer("auto")
    if renderer not in BACKENDS:
        pytest.skip("no off-screen graphics (EGL, OSMesa) on this machine")
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for name in ("MUJOCO_GL", "PYOPENGL_PLATFORM"):
        monkeypatch.setenv(name, "none")
    screen = OffscreenRenderer(model, 64, 48, renderer)
    assert os.environ["MUJOCO_GL"] == renderer
    assert os.environ["PYOPENGL_PLATFORM"] == renderer
    ahead = screen.draw(data, model.camera("ahead").id)
    back = screen.draw(data, model.camera("back").id)
    assert ahead.shape == (48, 64, 3)
    focal = 24.0 / np.tan(np.radians(30.0))
    for image, channel, (left, up) in (
        (ahead, 0, (0.5 / 1.8, 0.3 / 1.8)),
        (back, 2, (0.0, 0.0)),
    ):
        other = np.delete(image.astype(int), channel, axis=2).max(axis=2)
        rows, columns = np.nonzero(image[..., channel] > other + 100)
        assert columns.mean() + 0.5 == pytest.approx(32 - focal * left, abs=1)
        assert rows.mean() + 0.5 == pytest.approx(24 - focal * up, abs=1)
        assert len(rows) == pytest.approx((focal * 0.4 / 1.8) ** 2, rel=0.25)
    # An image drawn before is not drawn over.
    assert (ahead[..., 0] > 200).any() and (back[..., 2] > 200).any()

    def add(scene: mujoco.MjvScene) -> None:
        mujoco.mjv_initGeom(
            scene.geoms[scene.ngeom],
            mujoco.mjtGeom.mjGEOM_SPHERE,
            np.array([0.3, 0.0, 0.0]),
            np.array([-1.2, 0.0, 1.0]),
            np.eye(3).reshape(-1),
            np.array([0.0, 1.0, 0.0, 1.0], dtype=np.float32),
        )
        scene.ngeom += 1

    green = screen.draw(data, model.camera("back").id, add)[24, 32]
    assert green[1] > 2 * green[2]
    free = mujoco.MjvCamera()
    free.lookat[:] = 2.0, 0.5, 1.3
    free.distance, free.azimuth, free.elevation = 2.0, 0.0, 0.0
    red = screen.draw(data, free)[24, 32]
    assert red[0] > 200 and red[2] < 50
    screen.close()
    # Nothing is finer than a robot needs it: it has to be fast.
    quality = model.vis.quality
    assert quality.shadowsize == 0 == quality.offsamples
    assert (quality.numslices, quality.numstacks) == (12, 6)
    assert model.geom("floor").size[2] == 10.0
    assert model.vis.global_.offwidth == 64
    assert model.vis.global_.offheight == 48
