"""Test that a URDF moves like the model it was written from."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.description_types import SensorNames
from stepaside.robots.urdf_writer import BASE, urdf_of
from stored_values import DATA

# Anchors off the origin, two hinges on one body, a zero that is not 0, a
# slide, rotated bodies, a mesh-free ellipsoid and a continuous joint.
ODD = (DATA / "odd_robot.xml").read_text("utf-8")


def odd_robot(folder: Path, text: str = ODD) -> RobotDescription:
    (folder / "odd.xml").write_text(text)
    return RobotDescription(
        folder=folder,
        name="Odd robot",
        model="odd.xml",
        torso="chest",
        left_foot="left",
        right_foot="right",
        accent="",
        legs=(),
        standing={},
        speed_limits={"first": 7.0},
        sensors=SensorNames(gyro="turns"),
    )


def loaded(text: str) -> mujoco.MjModel:
    """Load a URDF by MuJoCo's own reader, with every link."""
    spec = mujoco.MjSpec.from_string(text)
    spec.compiler.fusestatic = False
    spec.compiler.discardvisual = False
    return spec.compile()


def pose_in(data: mujoco.MjData, root: str, body: str) -> Array:
    """Return position and axes of a body in another one, as (3, 4)."""
    base, own = data.body(root), data.body(body)
    axes = base.xmat.reshape(3, 3).T
    position = axes @ (own.xpos - base.xpos)
    return np.column_stack([position, axes @ own.xmat.reshape(3, 3)])


@pytest.mark.parametrize("robot", ["nao", "odd"])
def test_links_move_as_in_the_model(robot: str, tmp_path: Path) -> None:
    description = load_robot("nao") if robot == "nao" else odd_robot(tmp_path)
    original = description.compile()
    copy = loaded(urdf_of(description))
    assert copy.body_mass.sum() == pytest.approx(
        original.body_mass.sum(), rel=1e-6
    )
    first, second = mujoco.MjData(original), mujoco.MjData(copy)
    generator = np.random.default_rng(1)
    for joint in range(original.njnt):
        name = original.joint(joint).name
        if original.jnt_type[joint] != mujoco.mjtJoint.mjJNT_FREE:
            first.joint(name).qpos = angle = generator.uniform(-1.0, 1.0)
            second.joint(name).qpos = angle
    zero = mujoco.MjData(original)
    mujoco.mj_kinematics(original, zero)
    mujoco.mj_kinematics(original, first)
    mujoco.mj_kinematics(copy, second)
    mujoco.mj_comPos(original, first)
    mujoco.mj_comPos(copy, second)
    torso, compared = description.torso, 0
    for body in range(1, original.nbody):
        name = original.body(body).name
        expected = pose_in(first, torso, name)
        found = pose_in(second, BASE, name)
        if original.body_jntnum[body] and name != torso:
            last = original.body_jntadr[body] + original.body_jntnum[body]
            anchor = original.jnt_pos[last - 1]
            expected[:, 0] += expected[:, 1:] @ anchor
            expected[:, 1:] @= pose_in(zero, torso, name)[:, 1:].T
        np.testing.assert_allclose(found, expected, atol=1e-7)
        compared += 1
    assert compared == original.nbody - 1
    root = first.body(torso)
    center = root.xmat.reshape(3, 3).T @ (root.subtree_com - root.xpos)
    np.testing.assert_allclose(
        second.body(BASE).subtree_com, center, atol=1e-6
    )
    for side in ("left", "right"):
        site = first.site(getattr(description, f"{side}_foot"))
        axes = root.xmat.reshape(3, 3).T
        expected = np.column_stack(
            [axes @ (site.xpos - root.xpos), axes @ site.xmat.reshape(3, 3)]
        )
        found = pose_in(second, BASE, f"{side[0]}_sole")
        np.testing.assert_allclose(found, expected, atol=1e-7)


def test_a_body_may_have_the_name_of_a_frame(tmp_path: Path) -> None:
    text = ODD.replace('"upper"', f'"{BASE}"').replace('"tip"', '"imu_link"')
    model = loaded(urdf_of(odd_robot(tmp_path, text)))
    assert model.body("imu_link_body").parentid == model.body("lower").id
    assert model.body(f"{BASE}_body").id != model.body(BASE).id


def test_an_optical_frame_looks_along_z() -> None:
    data = mujoco.MjData(copy := loaded(urdf_of(load_robot("nao"))))
    mujoco.mj_kinematics(copy, data)
    camera = pose_in(data, BASE, "camera")[:, 1:]
    optical = pose_in(data, BASE, "camera_optical_frame")[:, 1:]
    np.testing.assert_allclose(optical[:, 2], camera[:, 0], atol=1e-9)
    np.testing.assert_allclose(optical[:, 0], -camera[:, 1], atol=1e-9)
    np.testing.assert_allclose(optical[:, 1], -camera[:, 2], atol=1e-9)


def test_another_reader_finds_tree_limits_and_shared_motor(
    tmp_path: Path,
) -> None:
    yourdfpy = pytest.importorskip("yourdfpy", reason="not installed")
    file = tmp_path / "robot.urdf"
    file.write_text(urdf_of(load_robot("nao")))
    robot = yourdfpy.URDF.load(str(file))
    assert robot.validate()
    assert robot.base_link == BASE
    pitch = robot.joint_map["RHipYawPitch"]
    assert pitch.mimic.joint == "LHipYawPitch"
    knee = robot.joint_map["LKneePitch"].limit
    model = load_robot("nao").compile()
    np.testing.assert_allclose(
        (knee.lower, knee.upper), model.joint("LKneePitch").range, atol=1e-6
    )
    file.write_text(urdf_of(odd_robot(tmp_path)))
    robot = yourdfpy.URDF.load(str(file))
    first = robot.joint_map["first"].limit
    assert (first.effort, first.velocity) == (10.0, 7.0)
    assert robot.joint_map["second"].type == "continuous"
    assert robot.joint_map["third"].type == "prismatic"
