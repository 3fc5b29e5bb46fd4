"""Test body settings: each error has its effect, and none at zero."""

from dataclasses import fields, replace
from math import radians
from typing import Any

import numpy as np
import pytest

from fake_robot import scheme_of
from stepaside.control import ControlScheme
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array, Pose
from stepaside.core.random_streams import named_generator
from stepaside.games.walk_game import WalkGame
from stepaside.games.walk_settings import WalkSettings
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.robots.leg_kinematics import LegKinematics
from stepaside.sim.body_settings import BODIES, BodySettings
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.push import Push
from stepaside.sim.sensor_errors import SensorErrors
from stepaside.sim.simulated_robot import SimulatedRobot
from stepaside.sim.world import World, build_model
from stepaside.strategies import Walk


def standing(
    body: BodySettings, tick: float = 0.004
) -> tuple[SimulatedRobot, ControlScheme]:
    walker = WalkGame(
        WalkSettings(body=body, physics=PhysicsSettings(tick=tick))
    ).walker
    return walker.robot, walker.scheme


def answer(body: BodySettings, cycles: int, step: float = 0.05) -> Array:
    """Angle of a head joint, cycle by cycle, after one changed request."""
    robot, scheme = standing(body, 0.012)
    targets = scheme.joint_targets.copy()
    start = robot.read().joint_positions[0]
    targets[0] += step
    angles = []
    for _ in range(cycles):
        robot.write(targets)
        robot.step()
        angles.append(robot.read().joint_positions[0] - start)
    return np.array(angles)


def test_a_target_moves_the_joint_after_the_delay() -> None:
    late = answer(BodySettings(delay_cycles=3), 12)
    assert np.abs(late[:3]).max() < 1e-4
    assert late[3] > 1e-3
    assert late[-1] == pytest.approx(0.05, abs=0.005)


def test_within_the_backlash_there_is_no_torque() -> None:
    """Only legs have backlash, half of it on either side."""
    robot, scheme = standing(BodySettings(backlash=radians(2.0)))
    names = scheme.kinematics.joint_names
    hip, head = names.index("LHipPitch"), names.index("HeadYaw")
    world = robot.world
    angles = robot.read().joint_positions
    off = []
    for step in (0.0, radians(0.9), radians(3.0)):
        robot.servos.reset(angles + step)
        world.before_step[0](0.0)
        off.append(world.data.ctrl - angles)
    assert abs(off[0][hip]) < 1e-12 and abs(off[1][hip]) < 1e-12
    assert off[2][hip] == pytest.approx(radians(2.0))
    assert off[1][head] == pytest.approx(radians(0.9))


def test_torque_falls_to_zero_at_the_no_load_speed() -> None:
    robot, _ = standing(BodySettings(torque_speed=True, efficiency=0.6))
    world = robot.world
    knee = world.model.actuator("walker/LKneePitch").id
    dof = world.model.joint("walker/LKneePitch").dofadr[0]
    stall = load_robot("nao").compile().actuator("LKneePitch").forcerange[1]
    speed = load_robot("nao").speed_limits["LKneePitch"]
    limits = []
    for share in (0.0, 0.5, 1.0, 2.0):
        world.data.qvel[dof] = share * speed
        world.before_step[0](0.0)
        limits.append(world.model.actuator_forcerange[knee].copy())
    upper = np.array(limits)[:, 1] / (0.6 * stall)
    np.testing.assert_allclose(upper, [1.0, 0.5, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(np.array(limits)[:, 0] / (0.6 * stall), -1.0)


def test_stiffness_limits_the_torque() -> None:
    robot, _ = standing(BodySettings(stiffness=0.5))
    world = robot.world
    ranges = world.model.actuator_forcerange
    whole = load_robot("nao").compile().actuator_forcerange
    np.testing.assert_allclose(ranges, 0.5 * whole)


def test_sensors_have_resolution_bias_noise_and_delay() -> None:
    body = BodySettings(
        encoder_step=0.01,
        gyro_bias=0.1,
        gyro_noise=0.01,
        imu_delay_cycles=2,
        force_gain_error=0.2,
    )
    sensors = SensorErrors(body, named_generator(1, "sensors"))
    angles = sensors.encoders(np.array([0.0149, -0.0151]))
    np.testing.assert_allclose(angles, [0.01, -0.02])
    zero = np.zeros(3)
    readings = [
        sensors.readings(zero, zero, np.zeros(8))[0] for _ in range(2000)
    ]
    bias, noise = np.mean(readings, axis=0), np.std(readings[10:], axis=0)
    assert 0.0 < np.abs(bias).max() < 0.1
    np.testing.assert_allclose(noise, 0.01, rtol=0.1)
    kick = np.array([5.0, 0.0, 0.0])
    seen = [
        sensors.readings(kick * (i == 0), zero, np.zeros(8))[0][0]
        for i in range(3)
    ]
    assert seen[2] > 4.0 > max(seen[:2])
    forces = sensors.readings(zero, zero, np.full(8, 10.0))[2]
    assert np.abs(forces / 10.0 - 1.0).max() <= 0.2
    assert np.ptp(forces) > 0.1


def test_mass_errors_change_masses_but_not_names() -> None:
    robots = {"walker": load_robot("nao")}
    physics = PhysicsSettings()
    right = build_model(robots, physics)
    body = BodySettings(mass_error=0.1, com_error=0.01)
    wrong = build_model(robots, physics, body, seed=3)
    again = build_model(robots, physics, body, seed=3)
    ratio = wrong.body_mass[1:] / right.body_mass[1:]
    assert ratio.min() >= 0.9 - 1e-9 and ratio.max() <= 1.1 + 1e-9
    assert np.ptp(ratio) > 0.05
    np.testing.assert_array_equal(wrong.body_mass, again.body_mass)
    torso = right.body("walker/torso").id
    shift = wrong.body_ipos[torso] - right.body_ipos[torso]
    assert 0.0 < np.abs(shift[:2]).max() <= 0.01 and shift[2] == 0.0


def test_a_slope_tilts_gravity() -> None:
    physics = PhysicsSettings(slope=0.1, slope_direction=np.pi / 2)
    model = build_model({"walker": load_robot("nao")}, physics)
    x, y, z = model.opt.gravity
    assert np.hypot(y, z) == pytest.approx(9.81)
    assert x == pytest.approx(0.0, abs=1e-12)
    assert y == pytest.approx(9.81 * np.sin(0.1))


def test_a_push_applies_its_impulse_in_the_robot_frame() -> None:
    description = load_robot("nao")
    kinematics = LegKinematics(description, tick=0.004)
    world = World({"walker": description}, PhysicsSettings())
    scheme = scheme_of(
        Walk(),
        GaitSettings(),
        kinematics,
        tick=0.004,
    )
    heading = 0.7
    robot = SimulatedRobot(
        world, "walker", description, kinematics, Pose(0.0, 0.0, heading)
    )
    robot.push(Push(1.5, 0.02, np.pi / 2))
    for _ in range(60):
        robot.write(scheme.joint_targets)
        robot.step()
    assert robot.pusher is not None
    given = np.array(robot.pusher.impulse)
    expected = 1.5 * np.array([-np.sin(heading), np.cos(heading)])
    np.testing.assert_allclose(given, expected, atol=0.02)
    torso = world.model.body("walker/torso").id
    np.testing.assert_array_equal(world.data.xfrc_applied[torso], 0.0)


@pytest.mark.parametrize(
    "name",
    [f.name for f in fields(BodySettings) if f.name != "torque_speed"],
)
def test_body_settings_refuse_values_out_of_range(name: str) -> None:
    changes: dict[str, Any] = {name: -1}
    with pytest.raises(ConfigurationError, match=name):
        replace(BodySettings(), **changes)


def test_presets_go_from_ideal_to_hardware() -> None:
    assert BODIES["ideal"].has_ideal_servos
    assert not BODIES["ideal"].has_sensor_errors
    hardware = BODIES["hardware"]
    assert hardware.delay_cycles * hardware.cycle == pytest.approx(0.036)
    assert not hardware.has_ideal_servos and hardware.has_sensor_errors
