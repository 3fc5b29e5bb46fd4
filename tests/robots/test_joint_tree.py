"""Test placed links of any robot against MuJoCo's own kinematics."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.joint_tree import joint_tree, place_frames
from stepaside.robots.tree_cache import load_tree
from synthetic_humanoid import synthetic_humanoid

ROBOTS = ["nao", "synthetic", "synthetic, seven joints a leg"]


def robot(name: str, folder: Path) -> RobotDescription:
    if name == "nao":
        return load_robot("nao")
    return synthetic_humanoid(folder, twists=name != "synthetic")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("share", ["all", "every other", "none"])
@pytest.mark.parametrize("name", ROBOTS)
def test_frames_and_com_are_those_of_mujoco(
    name: str, share: str, seed: int, tmp_path: Path
) -> None:
    """Whichever joints move, and at any angles of all of them."""
    description = robot(name, tmp_path)
    model, tree = description.compile(), load_tree(description)
    data = mujoco.MjData(model)
    angles = np.random.default_rng(seed).uniform(-1.5, 1.5, len(tree.joints))
    data.qpos[:7] = 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0
    data.qpos[7:] = angles
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    step = {"all": 1, "every other": 2, "none": len(angles)}[share]
    moved = tree.joints[::step] if share != "none" else ()
    fixed = dict(zip(tree.joints, angles.tolist(), strict=True))
    frames = [*tree.bodies.values(), *tree.sites.values()]
    columns = {joint: i for i, joint in enumerate(moved)}
    links = joint_tree(tree, columns, fixed, frames)
    com, n = np.empty(3), len(frames)
    places, axes = np.empty((n, 3)), np.empty((n, 3, 3))
    place_frames(links, angles[::step].copy(), com, places, axes)
    torso = data.body(description.torso).id
    np.testing.assert_allclose(com, data.subtree_com[torso], atol=1e-9)
    expected = [data.body(body) for body in tree.bodies]
    expected += [data.site(site) for site in tree.sites]
    for i, frame in enumerate(expected):
        np.testing.assert_allclose(places[i], frame.xpos, atol=1e-9)
        turned = frame.xmat.reshape(3, 3)
        np.testing.assert_allclose(axes[i], turned, atol=1e-9)
