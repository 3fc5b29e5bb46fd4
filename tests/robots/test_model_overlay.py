"""Test what is put on a published model, joint by joint and edge by edge."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.robots.description_types import (
    Overlay,
    SensorNames,
    ServoGains,
    SoleFrame,
)
from stepaside.robots.model_overlay import (
    IMU,
    THICKNESS,
    put_overlay,
    scaled_couplings,
)
from stored_values import DATA

MODEL = (DATA / "trunk.xml").read_text("utf-8")
TURN = (0.9, 0.1, -0.3, 0.2)  # of both soles, as quaternions of any length
SOLES = (
    SoleFrame("left", (0.01, 0.02, -0.05), TURN),
    SoleFrame("right", (0.03, -0.01, -0.04), TURN),
)
SERVOS = {
    "left_bend": ServoGains(50.0, 2.0, 7.0, 0.03),
    "right_bend": ServoGains(40.0, 1.0, 60.0),
}
SOLE = {"back": -0.05, "front": 0.11, "outer": 0.045, "inner": 0.03}
SENSORS = SensorNames()
ROBOT: dict[str, Any] = {
    "overlay": Overlay(SOLES, SERVOS),
    "torso": "trunk",
    "feet": ("l_sole", "r_sole"),
    "sole": SOLE,
    "sensors": SENSORS,
    "path": Path("made-up.xml"),
    "mesh_folders": [],
}


def model_with_overlay(joints: str = "", **changes: Any) -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_string(MODEL.format(joints=joints))
    put_overlay(spec, **(ROBOT | changes))
    return spec.compile()


def at_rest(model: mujoco.MjModel) -> mujoco.MjData:
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return data


def in_sole(data: mujoco.MjData, sole: str, point: Array) -> Array:
    """A point of the world in the frame of a sole."""
    site = data.site(sole)
    seen: Array = site.xmat.reshape(3, 3).T @ (point - site.xpos)
    return seen


@pytest.mark.parametrize("joints", ["", "<joint/>", "<freejoint/>"])
def test_the_torso_has_one_joint_that_is_free(joints: str) -> None:
    model = model_with_overlay(joints)
    assert model.body("trunk").jntnum == 1 and model.nv == 8


@pytest.mark.parametrize("sole", ["l_sole", "r_sole"])
def test_a_sole_is_a_box_over_its_outline(sole: str) -> None:
    model = model_with_overlay()
    data, box = at_rest(model), model.geom(f"{sole}_box")
    place = SOLES[sole == "r_sole"]
    body = data.body(place.body)
    origin = body.xpos + body.xmat.reshape(3, 3) @ place.place
    np.testing.assert_allclose(data.site(sole).xpos, origin, atol=1e-12)
    middle = in_sole(data, sole, data.geom(box.id).xpos)
    edge = SOLE["outer"], SOLE["inner"]
    left, inner = edge if sole == "l_sole" else edge[::-1]
    low, high = middle - box.size, middle + box.size
    wide = left + inner
    np.testing.assert_allclose(low, [SOLE["back"], -inner, 0.0], atol=1e-12)
    np.testing.assert_allclose(
        high, [SOLE["front"], left, THICKNESS * wide], atol=1e-12
    )
    turn = np.array(TURN) / np.linalg.norm(TURN)
    seen = np.zeros(9)
    mujoco.mju_quat2Mat(seen, turn)
    axes = body.xmat.reshape(3, 3) @ seen.reshape(3, 3)
    for thing in (data.site(sole), data.geom(box.id)):
        np.testing.assert_allclose(thing.xmat.reshape(3, 3), axes, atol=1e-12)


@pytest.mark.parametrize("foot", [0, 1])
def test_touch_sensors_are_at_the_corners_of_the_sole(foot: int) -> None:
    """Front left, front right, rear left, rear right, of the left foot."""
    model, sole = model_with_overlay(), ("l_sole", "r_sole")[foot]
    data, box = at_rest(model), model.geom(f"{sole}_box")
    middle = in_sole(data, sole, data.geom(box.id).xpos)
    names = SENSORS.feet[4 * foot : 4 * foot + 4]
    signs = [(1, 1), (1, -1), (-1, 1), (-1, -1)]
    for name, sign in zip(names, signs, strict=True):
        site = data.site(name)
        corner = in_sole(data, sole, site.xpos)
        wanted = middle[:2] + np.array(sign) * box.size[:2]
        np.testing.assert_allclose(corner, [*wanted, 0.0], atol=1e-12)
        size = model.site(name).size
        np.testing.assert_allclose(size[:2], 0.95 * box.size[:2])
        sensor = model.sensor(name)
        assert sensor.type == mujoco.mjtSensor.mjSENS_TOUCH
        assert sensor.objid == site.id


def test_the_imu_measures_rotation_and_acceleration() -> None:
    model, sensors = model_with_overlay(), SENSORS
    site = model.site(IMU)
    assert model.body(site.bodyid[0]).name == "trunk"
    assert not site.pos.any()
    kinds = mujoco.mjtSensor
    for name, kind in {
        sensors.gyro: kinds.mjSENS_GYRO,
        sensors.accelerometer: kinds.mjSENS_ACCELEROMETER,
    }.items():
        assert model.sensor(name).type == kind
        assert model.sensor(name).objid == site.id


@pytest.mark.parametrize("target", [0.05, 0.5, -0.5])
def test_a_servo_is_a_spring_a_damper_and_a_limit(target: float) -> None:
    model = model_with_overlay()
    data = mujoco.MjData(model)
    for name in SERVOS:
        data.joint(name).qpos[:] = 0.02
        data.joint(name).qvel[:] = 0.3
        data.actuator(name).ctrl[:] = target
    mujoco.mj_forward(model, data)
    for name, gains in SERVOS.items():
        torque = gains.stiffness * (target - 0.02) - gains.damping * 0.3
        torque = np.clip(torque, -gains.torque, gains.torque)
        assert data.actuator(name).force == pytest.approx(torque)
        assert data.joint(name).qfrc_actuator == pytest.approx(torque)
        assert data.joint(name).qfrc_passive == 0.0


@pytest.mark.parametrize(
    ("numbers", "odd"),
    [("0 1 0 0 0", 0), ("0 -1 0 0 0", 1), ("0 1 0 0.1 0", 1), ("1 1", 1)],
)
def test_only_equal_joints_stay_coupled(numbers: str, odd: int) -> None:
    words = (
        '<equality><joint joint1="left_bend" joint2="right_bend" '
        f'polycoef="{numbers}"/></equality></mujoco>'
    )
    text = MODEL.format(joints="").replace("</mujoco>", words)
    spec = mujoco.MjSpec.from_string(text)
    assert len(scaled_couplings(spec)) == odd
    put_overlay(spec, **ROBOT)
    assert spec.compile().neq == 1 - odd
