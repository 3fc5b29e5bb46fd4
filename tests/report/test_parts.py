"""Parts of a model as pages draw them, and the colours of pages."""

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.report import replay_page as library
from stepaside.report.palette import LIGHTS, PALETTES, contrast
from stepaside.report.visual_geoms import parts_of

MODEL = """
<mujoco>
<asset><material name="grass" rgba="0 0.5 0 1"/>
<mesh name="wedge" vertex="0 0 0  0.4 0 0  0 0.2 0  0 0 0.6"/></asset>
<worldbody><geom type="plane" size="1 1 1"/>
<geom type="box" size="0.05 5 1" pos="5 0 1"/>
<geom type="box" size="0.1 0.1 0.2" pos="2 0 0.2"/>
<body pos="1 2 3">
<geom type="capsule" size="0.02 0.1" pos="0.5 0 0" rgba="1 0 0 1"
quat="0.7071067811865476 0 0.7071067811865476 0"/>
<geom type="sphere" size="0.3" material="grass"/>
<geom type="box" size="0.1 0.4 0.025" pos="0 0 1" rgba="0 0 1 1"/>
<geom type="cylinder" size="0.05 0.2" rgba="0 0 0 1"/>
<geom type="ellipsoid" size="0.1 0.2 0.3"/>
<geom type="mesh" mesh="wedge"/>
<geom type="box" size="0.1 0.1 0.4" group="3"/>
</body></worldbody></mujoco>
"""


def test_parts_lie_in_their_body_as_they_are() -> None:
    model = mujoco.MjModel.from_xml_string(MODEL)
    wall, thing, capsule, sphere, box, cylinder, ellipsoid, mesh = parts_of(
        model
    )
    assert (wall.body, thing.body, capsule.body) == (0, 0, 1)
    assert (wall.is_wall, thing.is_wall, box.is_wall) == (True, False, False)
    kinds = [p.kind for p in (capsule, sphere, box, cylinder, ellipsoid)]
    assert kinds == ["capsule", "sphere", "box", "cylinder", "ellipsoid"]
    np.testing.assert_allclose(capsule.size[:2], [0.02, 0.1])
    np.testing.assert_allclose(capsule.place, [0.5, 0.0, 0.0])
    half = 0.5**0.5
    np.testing.assert_allclose(capsule.turn, [half, 0.0, half, 0.0])
    assert capsule.colour == (255, 0, 0) and sphere.colour == (0, 127, 0)
    np.testing.assert_allclose(box.size, [0.1, 0.4, 0.025])
    told = box.to_json()
    assert told["colour"] == "#0000ff" and told["kind"] == "box"
    assert told["place"] == [0.0, 0.0, 1.0] and told["body"] == 1
    assert mesh.kind == "mesh" and mesh.shell is not None
    frame = np.zeros(9)
    mujoco.mju_quat2Mat(frame, mesh.turn)
    corners = mesh.shell.corners @ frame.reshape(3, 3).T + mesh.place
    wanted = np.array([[0, 0, 0], [0, 0, 0.6], [0, 0.2, 0], [0.4, 0, 0]])
    order = np.lexsort(np.round(corners, 6).T[::-1])
    np.testing.assert_allclose(corners[order], wanted, atol=1e-6)
    told = mesh.to_json()
    assert len(told["corners"]) == len(told["faces"]) == 4


@pytest.mark.parametrize("light", LIGHTS)
def test_words_and_lines_of_pages_can_be_told_from_what_is_behind(
    light: str,
) -> None:
    """Words at 4.5 to 1, lines at 3 to 1, as WCAG asks."""
    here = PALETTES[light]
    for word in ("ink", "soft", "pursuer", "evader", "theory", "mean"):
        assert contrast(getattr(here, word), here.paper) > 4.5
    for line in ("pursuer", "evader", "theory", "support"):
        for behind in ("floor", "tile", "sky", "paper"):
            ratio = contrast(getattr(here, line), getattr(here, behind))
            assert ratio > 3.0, (line, behind)


def test_contrast_is_that_of_the_standard() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.005)
    assert contrast("#1f5fbf", "#1f5fbf") == 1.0


def test_the_library_is_three_with_its_licence_and_nothing_more() -> None:
    text = library.three()
    assert text.startswith("/**\n * @license\n")
    assert "SPDX-License-Identifier: MIT" in text[:200]
    assert "THREE={}" in text[:600]
    assert "</script" not in text and "@@" not in text
    assert "TrackballControls" not in text and "GLTFLoader" not in text


def test_a_trimesh_without_three_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    library.three.cache_clear()
    monkeypatch.setattr(library, "TEMPLATE", "another.html")
    with pytest.raises(ConfigurationError, match="trimesh that brings three"):
        library.three()
    library.three.cache_clear()
