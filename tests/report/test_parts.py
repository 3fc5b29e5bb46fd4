"""Visible geoms, colours of pages, and three.js."""

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.player_colours import from_hex
from stepaside.report import replay_page
from stepaside.report.palette import PALETTES
from stepaside.report.visual_geoms import (
    MAX_TRIANGLES,
    TriangleMesh,
    label_over,
    simplify,
    visual_geoms_of,
)

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


def test_geoms_keep_their_shape_pose_and_colour() -> None:
    model = mujoco.MjModel.from_xml_string(MODEL)
    wall, obstacle, capsule, sphere, box, cylinder, ellipsoid, mesh = (
        visual_geoms_of(model)
    )
    assert (wall.body, obstacle.body, capsule.body) == (0, 0, 1)
    walls = (wall.is_wall, obstacle.is_wall, box.is_wall)
    assert walls == (True, False, False)
    kinds = [p.kind for p in (capsule, sphere, box, cylinder, ellipsoid)]
    assert kinds == ["capsule", "sphere", "box", "cylinder", "ellipsoid"]
    np.testing.assert_allclose(capsule.size[:2], [0.02, 0.1])
    np.testing.assert_allclose(capsule.position, [0.5, 0.0, 0.0])
    half = 0.5**0.5
    np.testing.assert_allclose(capsule.quaternion, [half, 0.0, half, 0.0])
    assert capsule.colour == (255, 0, 0) and sphere.colour == (0, 127, 0)
    np.testing.assert_allclose(box.size, [0.1, 0.4, 0.025])
    values = box.to_json()
    assert values["colour"] == "#0000ff" and values["kind"] == "box"
    assert values["position"] == [0.0, 0.0, 1.0] and values["body"] == 1
    assert mesh.kind == "mesh" and mesh.mesh is not None
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, mesh.quaternion)
    vertices = mesh.mesh.vertices @ rotation.reshape(3, 3).T + mesh.position
    expected = np.array([[0, 0, 0], [0, 0, 0.6], [0, 0.2, 0], [0.4, 0, 0]])
    order = np.lexsort(np.round(vertices, 6).T[::-1])
    np.testing.assert_allclose(vertices[order], expected, atol=1e-6)
    values = mesh.to_json()
    assert len(values["vertices"]) == len(values["faces"]) == 4


def test_a_label_stands_over_the_highest_point_of_a_player() -> None:
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body name="a/trunk" pos="0 0 1">'
        '<geom size="0.2"/><body name="a/head" pos="0 0 0.3">'
        '<geom size="0.1"/></body></body><body name="b/trunk" pos="0 0 9">'
        '<geom size="1"/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    body, height = label_over(model, data, "a")
    assert body == 1 and height == pytest.approx(0.44)


def test_a_large_mesh_becomes_small_and_keeps_its_extent() -> None:
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.3)
    large = TriangleMesh(ball.vertices, ball.faces)
    small = simplify(large)
    assert 200 < len(small.faces) <= MAX_TRIANGLES < len(large.faces)
    radii = np.linalg.norm(small.vertices, axis=1)
    assert 0.27 < radii.min() and radii.max() <= 0.3 + 1e-9
    assert simplify(small) is small


def luminance(colour: str) -> float:
    linear = [
        c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
        for c in from_hex(colour)
    ]
    return float(np.dot([0.2126, 0.7152, 0.0722], linear))


def contrast(first: str, second: str) -> float:
    """Contrast ratio as WCAG 2.2 defines it, from 1 to 21."""
    darker, lighter = sorted(map(luminance, (first, second)))
    return (lighter + 0.05) / (darker + 0.05)


@pytest.mark.parametrize("theme", PALETTES)
def test_text_and_lines_of_pages_have_the_contrast_of_wcag(theme: str) -> None:
    """Text at least 4.5 to 1, lines at least 3 to 1."""
    palette = PALETTES[theme]
    for text in ("ink", "soft", "pursuer", "evader", "theory", "mean"):
        assert contrast(getattr(palette, text), palette.paper) > 4.5
    for line in ("pursuer", "evader", "theory", "support"):
        for background in ("floor", "tile", "sky", "paper"):
            ratio = contrast(
                getattr(palette, line), getattr(palette, background)
            )
            assert ratio > 3.0, (line, background)


def test_contrast_agrees_with_wcag() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.005)
    assert contrast("#1f5fbf", "#1f5fbf") == 1.0


def test_three_js_has_its_licence_and_nothing_else_is_included() -> None:
    text = replay_page.three_js()
    assert text.startswith("/**\n * @license\n")
    assert "SPDX-License-Identifier: MIT" in text[:200]
    assert "THREE={}" in text[:600]
    assert "</script" not in text and "@@" not in text
    assert "TrackballControls" not in text and "GLTFLoader" not in text


def test_a_trimesh_without_three_js_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    replay_page.three_js.cache_clear()
    monkeypatch.setattr(replay_page, "TEMPLATE", "another.html")
    with pytest.raises(
        ConfigurationError, match="trimesh that contains three"
    ):
        replay_page.three_js()
    replay_page.three_js.cache_clear()
