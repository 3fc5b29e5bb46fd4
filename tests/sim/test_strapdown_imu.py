"""Test the IMU that integrates between readings."""

import mujoco
import numpy as np
import pytest

from stepaside.sim.body_errors import StrapdownImu
from stored_values import DATA

MODEL = (DATA / "imu_box.xml").read_text("utf-8")
STEPS = 100  # 20 ms


@pytest.fixture
def world() -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    data.qpos[3:7] = 0.9, 0.1, -0.3, 0.3
    data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
    data.qvel[:] = [0.3, -0.2, 0.5, 0.4, -0.3, 0.8]
    return model, data


def imu_of(world: tuple[mujoco.MjModel, mujoco.MjData]) -> StrapdownImu:
    model, data = world
    return StrapdownImu(model, data, model.body("torso").id, 0)


def test_it_measures_the_mean_of_gyro_and_accelerometer(
    world: tuple[mujoco.MjModel, mujoco.MjData],
) -> None:
    """Against their samples, while forces and torques act."""
    model, data = world
    imu = imu_of(world)
    imu.read()
    samples = []
    for _ in range(STEPS):
        data.xfrc_applied[1] = [20.0, -9.0, 40.0, 0.3, -0.2, 0.1]
        mujoco.mj_step(model, data)
        samples.append(data.sensordata.copy())
    gyro, force, latest = imu.read()
    expected = np.mean(samples, axis=0)
    np.testing.assert_allclose(gyro, expected[:3], atol=1e-3)
    np.testing.assert_allclose(force, expected[3:], atol=0.02)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(latest, data.sensordata[:3], atol=1e-12)


def test_a_falling_body_feels_no_force_and_a_resting_one_its_weight(
    world: tuple[mujoco.MjModel, mujoco.MjData],
) -> None:
    model, data = world
    imu = imu_of(world)
    data.qvel[3:] = 0.0
    _, force, _ = imu.read()  # nothing has changed yet: as at rest
    mujoco.mj_forward(model, data)
    up = data.site_xmat[0].reshape(3, 3).T @ [0.0, 0.0, 9.81]
    np.testing.assert_allclose(force, up, atol=1e-9)
    mujoco.mj_step(model, data, nstep=STEPS)
    _, force, _ = imu.read()
    np.testing.assert_allclose(force, 0.0, atol=1e-9)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.2, 3.0])
def test_the_mean_rate_turns_one_orientation_into_the_next(
    angle: float, world: tuple[mujoco.MjModel, mujoco.MjData]
) -> None:
    model, data = world
    axis = np.array([0.6, 0.0, -0.8])
    first = np.array([0.5, -0.5, 0.5, 0.5])
    turn = np.array([np.cos(angle / 2), *(np.sin(angle / 2) * axis)])
    second = np.empty(4)
    mujoco.mju_mulQuat(second, first, turn)
    mount = np.empty(9)
    mujoco.mju_quat2Mat(mount, model.site_quat[0])
    for sign in (1.0, -1.0):  # a quaternion and its negative are one
        imu = imu_of(world)
        data.time, data.qpos[3:7] = 0.0, first
        imu.read()
        data.time, data.qpos[3:7] = 0.5, sign * second
        rate, _, _ = imu.read()
        np.testing.assert_allclose(
            0.5 * rate, (angle * axis) @ mount.reshape(3, 3), atol=1e-12
        )
