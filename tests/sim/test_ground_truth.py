"""Test the true state of a box at any pose."""

from math import hypot, radians

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.core.rotations import rotation
from stepaside.sim.ground_truth import TrueRobotState


def put(
    x: float,
    y: float,
    roll: float,
    pitch: float,
    yaw: float,
    com_forward: float = 0.0,
) -> TrueRobotState:
    """A box with its CoM above its origin, its angles in degrees."""
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body name="box"><freejoint/>'
        '<geom type="box" size="0.1 0.1 0.1" pos="0 0 0.2"/>'
        "</body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    data.qpos[:3] = x, y, 0.4
    axes = rotation(radians(roll), radians(pitch), radians(yaw))
    mujoco.mju_mat2Quat(data.qpos[3:7], axes.reshape(-1))
    mujoco.mj_forward(model, data)
    return TrueRobotState(model, data, "box", com_forward=com_forward)


def test_position_heading_and_com_are_those_of_the_torso() -> None:
    truth = put(1.0, -2.0, 0.0, 0.0, 130.0)
    assert truth.position_torso_in_world == (1.0, -2.0)
    assert truth.heading_in_world == pytest.approx(radians(130.0))
    np.testing.assert_allclose(truth.position_com_in_world, (1.0, -2.0, 0.6))
    assert put(0, 0, 20.0, 0.0, -50.0).heading_in_world == pytest.approx(
        radians(-50)
    )


@pytest.mark.parametrize("yaw", [0.0, 90.0, -130.0])
def test_the_reference_point_is_behind_the_com(yaw: float) -> None:
    truth = put(1.0, -2.0, 0.0, 0.0, yaw, com_forward=0.02)
    turned = Pose(
        *truth.position_reference_in_world, truth.heading_in_world
    ).compose(Pose(0.02, 0.0, 0.0))
    np.testing.assert_allclose(
        turned[:2], truth.position_com_in_world[:2], atol=1e-12
    )
    lean = put(1.0, -2.0, 0.0, 30.0, yaw, com_forward=0.0)
    x, y = lean.position_reference_in_world
    np.testing.assert_allclose((x, y), lean.position_com_in_world[:2])
    assert hypot(x - 1.0, y + 2.0) > 0.05


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("yaw", [0.0, 77.0])
def test_a_torso_has_fallen_beyond_45_degrees(sign: float, yaw: float) -> None:
    assert not put(0, 0, 0.0, 0.0, yaw).has_fallen
    for roll, pitch in ((1.0, 0.0), (0.0, 1.0)):
        for lean, fallen in ((44.0, False), (46.0, True), (120.0, True)):
            lean *= sign
            truth = put(0, 0, roll * lean, pitch * lean, yaw)
            assert truth.has_fallen is fallen
