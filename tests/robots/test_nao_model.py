"""Test the NAO's model against the published tables."""

import csv
from pathlib import Path

import mujoco
import numpy as np
import pytest

from stepaside.robots.description import load_robot

DATA = Path(__file__).parents[1] / "data"
NAO = load_robot("nao")
MODEL = NAO.compile()


def table(name: str) -> list[dict[str, str]]:
    with (DATA / name).open(newline="") as file:
        return list(csv.DictReader(file))


LINKS, JOINTS = table("nao_links.csv"), table("nao_joints.csv")


def numbers(row: dict[str, str], *names: str) -> np.ndarray:
    return np.array([float(row[name]) for name in names])


def test_masses_of_25_links_equal_the_table() -> None:
    assert len(LINKS) == MODEL.nbody - 1 == 25
    assert MODEL.body_subtreemass[0] == pytest.approx(5.30535, abs=2e-4)


@pytest.mark.parametrize("row", LINKS, ids=lambda row: row["link"])
def test_mass_center_and_inertia_of_a_link(row: dict[str, str]) -> None:
    body = MODEL.body(row["link"])
    assert body.mass[0] == pytest.approx(float(row["mass_kg"]), rel=1e-6)
    center = numbers(row, "com_x_m", "com_y_m", "com_z_m")
    np.testing.assert_allclose(body.ipos, center, atol=1e-9)
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, body.iquat)
    frame = turn.reshape(3, 3)
    inertia = frame @ np.diag(body.inertia) @ frame.T
    xx, yy, zz, xy, xz, yz = numbers(
        row, *(f"i{ij}_com" for ij in ("xx", "yy", "zz", "xy", "xz", "yz"))
    )
    expected = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    np.testing.assert_allclose(inertia, expected, atol=2e-9)


@pytest.mark.parametrize("row", JOINTS, ids=lambda row: row["joint"])
def test_place_axis_and_limits_of_a_joint(row: dict[str, str]) -> None:
    joint = MODEL.joint(row["joint"])
    body = MODEL.body(row["child_link"])
    assert joint.bodyid[0] == body.id
    assert body.parentid[0] == MODEL.body(row["parent_link"]).id
    origin = numbers(row, "origin_x_m", "origin_y_m", "origin_z_m")
    np.testing.assert_allclose(body.pos, origin, atol=1e-9)
    axis = numbers(row, "axis_x", "axis_y", "axis_z")
    np.testing.assert_allclose(joint.axis, axis, atol=1e-6)
    limits = numbers(row, "lower_rad", "upper_rad")
    np.testing.assert_allclose(joint.range, limits, atol=1e-6)


@pytest.mark.parametrize("row", JOINTS, ids=lambda row: row["joint"])
def test_torque_and_speed_of_a_motor(row: dict[str, str]) -> None:
    if row["joint"] == "RHipYawPitch":  # driven by the motor of the left one
        assert row["joint"] not in NAO.speed_limits
        return
    motor = MODEL.actuator(row["joint"])
    torque = float(row["v6_stall_torque_ideal_Nm"])
    np.testing.assert_allclose(motor.forcerange, [-torque, torque], rtol=1e-5)
    speed = float(row["v6_noload_speed_rad_s"])
    assert NAO.speed_limits[row["joint"]] == pytest.approx(speed, abs=1e-3)


def test_foot_force_sensors_are_at_the_published_positions() -> None:
    places = {
        "l_fsr_front_left": (0.07025, 0.0299),
        "l_fsr_front_right": (0.07025, -0.0231),
        "l_fsr_rear_left": (-0.03025, 0.0299),
        "l_fsr_rear_right": (-0.02965, -0.0191),
        "r_fsr_front_left": (0.07025, 0.0231),
        "r_fsr_front_right": (0.07025, -0.0299),
        "r_fsr_rear_left": (-0.02965, 0.0191),
        "r_fsr_rear_right": (-0.03025, -0.0299),
    }
    for name, place in places.items():
        np.testing.assert_allclose(MODEL.site(name).pos[:2], place)
