"""Test postures of robots against MuJoCo's own, to the last digits."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ModelError
from stepaside.core.poses import Array
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.joint_configuration import Configuration
from stepaside.robots.tree_cache import load_tree
from stepaside.robots.tree_compiler import compile_tree
from synthetic_humanoid import synthetic_humanoid

ROBOTS = ["nao", "synthetic", "synthetic, seven joints a leg"]


def robot(name: str, folder: Path) -> RobotDescription:
    if name == "nao":
        return load_robot("nao")
    return synthetic_humanoid(folder, twists=name != "synthetic")


def random_posture(
    robot: RobotDescription, seed: int
) -> tuple[mujoco.MjModel, mujoco.MjData, Configuration]:
    """Any angles, any place, any tilt, in MuJoCo and here."""
    model = robot.compile()
    data = mujoco.MjData(model)
    q = np.random.default_rng(seed).uniform(-1.5, 1.5, model.nq)
    q[3:7] /= np.linalg.norm(q[3:7])
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    torso = data.body(robot.torso)
    axes = torso.xmat.reshape(3, 3)
    tree = load_tree(robot)
    return model, data, Configuration(tree, q[7:], torso.xpos, axes)


def by_torso_in_world(jacobian: Array, axes: Array) -> Array:
    """MuJoCo turns a free joint about its own axes; we, the world's."""
    turned = jacobian.copy()
    turned[:, 3:6] = jacobian[:, 3:6] @ axes.T
    return turned


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ROBOTS)
def test_transforms_and_com_are_those_of_mujoco(
    name: str, seed: int, tmp_path: Path
) -> None:
    description = robot(name, tmp_path)
    _, data, ours = random_posture(description, seed)
    torso = data.body(description.torso).id
    np.testing.assert_allclose(ours.com, data.subtree_com[torso], atol=1e-9)
    found = [
        *((ours.body_in_world(x), data.body(x)) for x in ours.tree.bodies),
        *((ours.site_in_world(x), data.site(x)) for x in ours.tree.sites),
    ]
    for (place, axes), theirs in found:
        np.testing.assert_allclose(place, theirs.xpos, atol=1e-9)
        np.testing.assert_allclose(axes.ravel(), theirs.xmat, atol=1e-9)


@pytest.mark.parametrize("name", ROBOTS)
def test_jacobians_are_those_of_mujoco(name: str, tmp_path: Path) -> None:
    description = robot(name, tmp_path)
    model, data, ours = random_posture(description, 7)
    for site in ours.tree.sites:
        theirs = np.zeros((6, model.nv))
        number = model.site(site).id
        mujoco.mj_jacSite(model, data, theirs[:3], theirs[3:], number)
        np.testing.assert_allclose(
            ours.jacobian_of_site(site),
            by_torso_in_world(theirs, ours.axes),
            atol=1e-9,
        )
    theirs = np.zeros((3, model.nv))
    torso = model.body(description.torso).id
    mujoco.mj_jacSubtreeCom(model, data, theirs, torso)
    np.testing.assert_allclose(
        ours.jacobian_of_com(),
        by_torso_in_world(theirs, ours.axes),
        atol=1e-9,
    )


@pytest.mark.parametrize("name", ROBOTS)
def test_a_tree_knows_masses_motors_and_ranges(
    name: str, tmp_path: Path
) -> None:
    description = robot(name, tmp_path)
    model, tree = description.compile(), compile_tree(description)
    torso = model.body(description.torso).id
    assert tree.mass == pytest.approx(model.body_subtreemass[torso])
    assert len(tree.links) == model.njnt
    for motor, joint in enumerate(tree.motors):
        assert model.joint(model.actuator_trnid[motor, 0]).name == joint
    for joint in tree.joints:
        link = tree.links[tree.link_of(joint)]
        assert (link.low, link.high) == tuple(model.joint(joint).range)


def test_missing_bodies_and_sites_are_named() -> None:
    tree = load_tree(load_robot("nao"))
    ours = Configuration(tree, np.zeros(len(tree.joints)))
    with pytest.raises(ModelError, match="no site 'tail'; there are .*imu"):
        ours.site_in_world("tail")
    with pytest.raises(ModelError, match="no body 'tail'; there are .*head"):
        ours.body_in_world("tail")
    with pytest.raises(ModelError, match="must be 24 angles, got 3"):
        Configuration(tree, np.zeros(3))
