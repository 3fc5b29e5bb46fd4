"""Visible geoms, colours of pages, and three.js."""

import mujoco
import numpy as np

from stepaside.report import replay_page
from stepaside.report.visual_geoms import visual_geoms_of

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


def test_three_js_has_its_licence_and_nothing_else_is_included() -> None:
    text = replay_page.three_js()
    assert text.startswith("/**\n * @license\n")
    assert "SPDX-License-Identifier: MIT" in text[:200]
    assert "THREE={}" in text[:600]
    assert "</script" not in text and "@@" not in text
    assert "TrackballControls" not in text and "GLTFLoader" not in text
