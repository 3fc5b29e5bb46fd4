"""Test body settings: each error has its effect, and none at zero."""

import numpy as np
import pytest

from stepaside.control import ControlScheme
from stepaside.core.poses import Array
from stepaside.games.game_settings import walk
from stepaside.games.recorded_game import RecordedGame
from stepaside.robots.description import load_robot
from stepaside.sim.body_settings import BODIES, BodySettings
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.simulated_robot import SimulatedRobot
from walkers import walker_of


def standing(
    body: BodySettings, tick: float = 0.004
) -> tuple[SimulatedRobot, ControlScheme]:
    physics = PhysicsSettings(tick=tick)
    walker = walker_of(RecordedGame(walk(body=body, physics=physics)))
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


def test_an_ideal_body_has_ideal_servos_and_exact_sensors() -> None:
    found = [
        (b.has_ideal_servos, b.has_sensor_errors) for b in BODIES.values()
    ]
    assert found == [(True, False), (False, True), (False, True)]
    assert not BodySettings(backlash=0.01).has_ideal_servos
    assert BodySettings(backlash=0.01, gyro_noise=0.1).has_sensor_errors


def test_a_target_moves_the_joint_after_the_delay() -> None:
    late = answer(BodySettings(delay_cycles=3), 12)
    assert np.abs(late[:3]).max() < 1e-4
    assert late[3] > 1e-3
    assert late[-1] == pytest.approx(0.05, abs=0.005)


def test_stiffness_limits_the_torque() -> None:
    robot, _ = standing(BodySettings(stiffness=0.5))
    world = robot.world
    ranges = world.model.actuator_forcerange
    whole = load_robot("nao").compile().actuator_forcerange
    np.testing.assert_allclose(ranges, 0.5 * whole)
