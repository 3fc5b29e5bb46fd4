"""Test the ways in which published models are odd, and still read."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

import vendor_humanoid as stranger
from stepaside.core.errors import ModelError
from stepaside.fitting.derivation import derive
from stepaside.fitting.description_writer import write_description
from stepaside.fitting.model_analysis import analyse_model
from stepaside.robots.description import FILE, RobotDescription, load_robot
from stepaside.robots.model_overlay import rotate_torso_frame
from stepaside.robots.model_reader import read_model

TURNS = {
    "backward": (0.0, 0.0, 0.0, 1.0),
    "left": (np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)),
    "right": (np.sqrt(0.5), 0.0, 0.0, -np.sqrt(0.5)),
}


def described(model: Path, folder: Path) -> RobotDescription:
    folder.mkdir()
    text = write_description(derive(model, folder, []))
    (folder / FILE).write_text(text, encoding="utf-8")
    return load_robot(folder)


def turned(straight: Path, folder: Path, looks: str) -> Path:
    """The same robot, in a file whose torso looks elsewhere."""
    spec = read_model(straight)
    for mesh in list(spec.meshes):
        spec.delete(next(g for g in spec.geoms if g.meshname == mesh.name))
        spec.delete(mesh)
    for thing in (*spec.worldbody.geoms, *spec.keys):
        spec.delete(thing)
    root = spec.body("chest")
    for joint in list(root.joints):
        spec.delete(joint)
    rotate_torso_frame(spec, "chest", TURNS[looks])
    root.add_freejoint()
    spec.compile()
    file = folder / "turned.xml"
    file.write_text(spec.to_xml())
    return file


@pytest.mark.parametrize("looks", TURNS)
def test_a_torso_may_face_any_direction(looks: str, tmp_path: Path) -> None:
    straight = stranger.mjcf(tmp_path)
    plain = analyse_model(straight, [])
    found = analyse_model(turned(straight, tmp_path, looks), [])
    assert plain.turn == (1.0, 0.0, 0.0, 0.0)
    back = np.array(TURNS[looks]) * (1.0, -1.0, -1.0, -1.0)
    assert abs(float(back @ found.turn)) == pytest.approx(1.0)
    for leg, other in zip(found.legs, plain.legs, strict=True):
        assert leg.joints == other.joints and leg.signs == other.signs
        np.testing.assert_allclose(leg.hip, other.hip, atol=1e-9)
        assert leg.outline == pytest.approx(other.outline, abs=1e-9)


def test_a_rotated_torso_keeps_its_links_in_place(tmp_path: Path) -> None:
    """Its mass and feet lie where those of one that looks ahead do."""
    straight = stranger.mjcf(tmp_path)
    robots = [
        described(straight, tmp_path / "plain"),
        described(turned(straight, tmp_path, "left"), tmp_path / "turned"),
    ]
    seen = []
    for robot in robots:
        model = robot.compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        feet = [data.site(n) for n in (robot.left_foot, robot.right_foot)]
        poses = [np.r_[foot.xpos, foot.xmat] for foot in feet]
        seen.append(np.r_[data.subtree_com[0], *poses])
    assert robots[0].gait == pytest.approx(robots[1].gait, rel=1e-3)
    assert robots[0].standing == robots[1].standing
    np.testing.assert_allclose(seen[1], seen[0], atol=1e-6)


def test_the_inertia_is_rotated_with_the_torso_frame() -> None:
    """Also the part of a full inertia that no axis is one of."""
    text = """<mujoco><worldbody><body name="chest"><freejoint/>
      <inertial pos="0.1 0.2 0.3" mass="2"
        fullinertia="0.3 0.25 0.15 0.02 0.01 -0.03"/>
      <geom type="sphere" size="0.1"/></body></worldbody></mujoco>"""
    spec = mujoco.MjSpec.from_string(text)
    wholes = []
    for _ in range(2):
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        axes = data.ximat[1].reshape(3, 3)
        wholes.append(axes @ np.diag(model.body_inertia[1]) @ axes.T)
        place = data.xipos[1].copy()
        rotate_torso_frame(spec, "chest", TURNS["left"])
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(wholes[1], turn @ wholes[0] @ turn.T, atol=1e-9)
    np.testing.assert_allclose(place, (-0.2, 0.1, 0.3), atol=1e-12)


def test_settings_unknown_to_mujoco_are_ignored(tmp_path: Path) -> None:
    file = stranger.mjcf(tmp_path)
    text = file.read_text()
    dated = text.replace(
        '<option timestep="0.005"/>',
        '<option timestep="0.005" cat="3">'
        '<flag sensornoise="enable" frictionloss="enable"/></option>',
    )
    assert dated != text
    file.write_text(dated)
    assert analyse_model(file, []).mass == pytest.approx(25.2)
    file.write_text(dated.replace('axis="0 1 0"', 'axis="0 1 0" cat="3"', 1))
    with pytest.raises(ModelError, match="unrecognized attribute: 'cat'"):
        analyse_model(file, [])


def test_an_outdated_model_may_include_files(tmp_path: Path) -> None:
    text = stranger.mjcf(tmp_path).read_text()
    start = text.index("<worldbody>")
    end = text.index("</worldbody>") + len("</worldbody>")
    (tmp_path / "body.xml").write_text(
        f"<mujocoinclude>{text[start:end]}</mujocoinclude>"
    )
    whole = tmp_path / "whole.xml"
    whole.write_text(
        f'{text[:start]}<option><flag sensornoise="enable"/></option>'
        f'<include file="body.xml"/>{text[end:]}'
    )
    assert analyse_model(whole, []).mass == pytest.approx(25.2)


@pytest.mark.parametrize("suffix", ["stl", "STL"])
def test_meshes_are_found_in_their_package(
    suffix: str, tmp_path: Path
) -> None:
    folder = tmp_path / "them" / "urdf"
    folder.mkdir(parents=True)
    file = stranger.urdf(folder)
    text = file.read_text()
    mesh = f"package://them/shapes/shell.{suffix}"
    shape = f'<geometry><mesh filename="{mesh}"/></geometry>'
    shown = f"<collision>{shape}</collision>"
    place = text.index('<link name="chest">') + len('<link name="chest">')
    file.write_text(text[:place] + shown + text[place:])
    assert analyse_model(file, []).missing == (mesh,)
    # A tetrahedron half of whose faces look inward: without volume.
    faces = [[0, 2, 1], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    places = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "<f4")
    corners = places[faces]
    rows = b"".join(bytes(12) + c.tobytes() + bytes(2) for c in corners)
    (tmp_path / "them" / "shapes").mkdir()
    (tmp_path / "them" / "shapes" / f"shell.{suffix}").write_bytes(
        bytes(80) + len(corners).to_bytes(4, "little") + rows
    )
    assert analyse_model(file, []).missing == ()
