"""Test the kinematics of the measured body against MuJoCo's own."""

from functools import cache

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array, Pose
from stepaside.core.rotations import rotation
from stepaside.perception.body_pose import BodyKinematics
from stepaside.robots.description import load_robot
from stepaside.robots.description_types import FOOT_FORCES
from stepaside.robots.forward_kinematics import ForwardKinematics
from stepaside.robots.head import load_head
from stepaside.robots.tree_compiler import coupled_joints

NAO = load_robot("nao")
TILT, HEADING = (0.06, -0.11), 2.7  # roll and pitch; yaw, in [rad]


@cache
def kinematics() -> BodyKinematics:
    return BodyKinematics(NAO, load_head(NAO))


@cache
def forward() -> ForwardKinematics:
    return ForwardKinematics(NAO)


def bent() -> tuple[mujoco.MjModel, mujoco.MjData, Array]:
    """NAO tilted and turned, with other angles in all of its joints."""
    model = NAO.compile()
    data = mujoco.MjData(model)
    names = [
        model.joint(model.actuator_trnid[i, 0]).name for i in range(model.nu)
    ]
    data.qpos[:3] = 0.7, -0.4, 0.31
    axes = rotation(*TILT, HEADING)
    mujoco.mju_mat2Quat(data.qpos[3:7], axes.reshape(-1))
    generator = np.random.default_rng(3)
    angles = np.zeros(len(names))
    for i, name in enumerate(names):
        low, high = model.joint(name).range
        angles[i] = low + (high - low) * generator.uniform(0.3, 0.7)
        data.joint(name).qpos[0] = angles[i]
    for follower, leader in coupled_joints(model, "nao").items():
        data.joint(follower).qpos[0] = data.joint(leader).qpos[0]
    mujoco.mj_forward(model, data)
    return model, data, angles


@pytest.mark.parametrize("left", [True, False])
def test_torso_and_head_poses_equal_those_of_the_simulation(
    left: bool,
) -> None:
    """From the standing foot, the encoders and the measured tilt."""
    _, data, angles = bent()
    foot = data.site(NAO.left_foot if left else NAO.right_foot)
    x, y, height = foot.xpos.tolist()
    turned = float(np.arctan2(foot.xmat[3], foot.xmat[0]))
    body = kinematics().pose(1.5, angles, Pose(x, y, turned), left, TILT)
    rise = np.array([0.0, 0.0, height])
    torso, head = data.body("torso"), data.body("head")
    assert body.time == 1.5
    np.testing.assert_allclose(
        body.position_torso_in_odometry, torso.xpos - rise
    )
    np.testing.assert_allclose(
        body.axes_torso_in_odometry.reshape(-1), torso.xmat
    )
    np.testing.assert_allclose(
        body.position_head_in_odometry, head.xpos - rise
    )
    np.testing.assert_allclose(
        body.axes_head_in_odometry.reshape(-1), head.xmat
    )
    assert body.pose_torso_in_odometry == pytest.approx((0.7, -0.4, HEADING))
    assert body.yaw == data.joint("HeadYaw").qpos[0]
    assert body.pitch == data.joint("HeadPitch").qpos[0]
    assert body.yaw != body.pitch


def test_the_body_moves_with_its_stance_foot() -> None:
    _, _, angles = bent()
    start = kinematics().pose(0.0, angles, Pose(0, 0, 0), True, TILT)
    moved = Pose(0.4, -0.3, 1.0)
    body = kinematics().pose(0.0, angles, moved, True, TILT)
    assert body.pose_torso_in_odometry == pytest.approx(
        moved.compose(start.pose_torso_in_odometry)
    )
    head = moved.transform_points(start.position_head_in_odometry[None, :2])[0]
    np.testing.assert_allclose(body.position_head_in_odometry[:2], head)
    assert body.position_head_in_odometry[2] == pytest.approx(
        start.position_head_in_odometry[2]
    )


def test_force_sensors_sit_at_the_corners_of_the_soles() -> None:
    """Left before right; front-left, front-right, rear-left, rear-right."""
    assert [name[0] for name in FOOT_FORCES] == 4 * ["l"] + 4 * ["r"]
    corners = forward().force_sensors()
    np.testing.assert_array_equal(
        np.sign(corners), 2 * [(1, 1), (1, -1), (-1, 1), (-1, -1)]
    )
    # Feet are mirror images: left of one is right of the other.
    mirrored = corners[[5, 4, 7, 6]] * (1.0, -1.0)
    np.testing.assert_allclose(corners[:4], mirrored, atol=1e-12)
    assert corners[0] == pytest.approx((0.07025, 0.0299))
