"""Test a simulated robot: sensors, servos, fall and reference point."""

from math import cos, sin
from typing import Any

import mujoco
import numpy as np
import pytest

from fake_robot import walk_of
from stepaside.control import ControlScheme
from stepaside.control.sight_sources import MeasuredSight
from stepaside.core.poses import Array, Pose
from stepaside.core.random_streams import named_generator
from stepaside.games.walker import SimulatedPlayer
from stepaside.games.walker_factory import (
    RobotSensing,
    WalkerSetup,
    place_walker,
)
from stepaside.locomotion.walk_snapshots import Phase
from stepaside.locomotion.zmp.control_settings import OPEN_LOOP, STABILISED
from stepaside.locomotion.zmp.feedback_loop import ClosedLoop, OpenLoop
from stepaside.perception.measurement import Sighting
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.robots.description_types import FOOT_FORCES
from stepaside.sim.body_settings import BodySettings
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.sim.push import Push
from stepaside.sim.sensor_errors import SensorErrors
from stepaside.sim.servos import RealisticServos
from stepaside.sim.simulated_robot import SimulatedRobot
from stepaside.sim.world import World
from stepaside.strategies import Pursuit

NAO = load_robot("nao")
FRAME = Pose(1.2, -0.7, 0.9)


def walker(
    frame: Pose = FRAME,
    *,
    feedback: bool = False,
    sights: Any = (),
    **effects: Any,
) -> SimulatedPlayer:
    """The second of two robots in a world."""
    body = BodySettings(**effects)
    physics = PhysicsSettings(tick=0.012)
    world = World({"first": NAO, "second": NAO}, physics, body)
    world.data.qpos[:3] = (-9.0, 0.0, 0.33)  # out of the way
    made = place_walker(
        world,
        WalkerSetup(
            "second",
            NAO,
            GaitSettings(),
            STABILISED if feedback else OPEN_LOOP,
            body,
            odometry_in_world=frame,
            seed=5,
        ),
        Pursuit(),
        sensing=RobotSensing(MeasuredSight(Sighting(0.0, 0.2, 2.0)), sights),
    )
    mujoco.mj_forward(world.model, world.data)
    return made


def stand(
    frame: Pose = FRAME, *, feedback: bool = False, **effects: Any
) -> tuple[SimulatedRobot, ControlScheme]:
    """Its body and its control."""
    made = walker(frame, feedback=feedback, **effects)
    return made.robot, made.scheme


def command_of(robot: SimulatedRobot) -> Array:
    """Commanded joint angles, in [rad]. The robot is the second of two."""
    command: Array = robot.world.data.ctrl.copy()
    return command[command.size // 2 :]


def test_a_robot_starts_at_its_odometry_frame() -> None:
    robot, scheme = stand()
    # The torso stands over the feet, on the line between them.
    place = FRAME.inverse().transform_points(
        [robot.truth.position_torso_in_world]
    )[0]
    assert abs(place[0]) < 0.03 and abs(place[1]) < 1e-6
    assert robot.truth.heading_in_world == pytest.approx(FRAME.theta)
    data = robot.world.data
    wanted = scheme.kinematics.posture
    assert robot.qpos_slice.stop - robot.qpos_slice.start == wanted.size
    np.testing.assert_array_equal(data.qpos[robot.qpos_slice][7:], wanted[7:])
    kept = robot.posture
    np.testing.assert_array_equal(kept, data.qpos[robot.qpos_slice])
    data.qpos[robot.qpos_slice][7] += 1.0
    assert robot.posture[7] == kept[7] + 1.0  # a copy, of its instant
    data.qpos[robot.qpos_slice][7] = kept[7]
    measured = robot.read()
    np.testing.assert_allclose(
        measured.joint_positions, scheme.joint_targets, atol=1e-12
    )
    np.testing.assert_allclose(
        data.ctrl[data.ctrl.size // 2 :], scheme.joint_targets
    )
    np.testing.assert_array_equal(data.ctrl[: data.ctrl.size // 2], 0.0)


def test_a_robot_reads_its_own_sensors() -> None:
    """Each simulated sensor appears in its field of the measurement."""
    robot, _ = stand()
    model, data = robot.world.model, robot.world.data
    data.sensordata[:] = np.arange(data.sensordata.size)
    measured = robot.read()

    def values(sensor: str) -> Array:
        found: Array = data.sensor(f"second/{sensor}").data
        return found

    np.testing.assert_array_equal(measured.gyro, values("gyro"))
    np.testing.assert_array_equal(
        measured.accelerometer, values("accelerometer")
    )
    forces = [values(name)[0] for name in FOOT_FORCES]
    np.testing.assert_array_equal(measured.foot_forces, forces)
    assert measured.time == 0.0 and measured.percepts == ()
    assert measured.sighting is None
    # What was read is kept when time goes on.
    data.sensordata[:] = 0.0
    np.testing.assert_array_equal(measured.foot_forces, forces)
    assert measured.gyro.any() and measured.accelerometer.any()
    assert model.nsensordata == data.sensordata.size


def test_the_zmp_is_the_centre_of_the_forces_at_the_soles() -> None:
    robot, _ = stand()
    data = robot.world.data
    forces = np.arange(1.0, 9.0)
    for name, force in zip(FOOT_FORCES, forces, strict=True):
        data.sensor(f"second/{name}").data[:] = force
    corners = np.array(
        [data.site(f"second/{name}").xpos[:2] for name in FOOT_FORCES]
    )
    expected = (forces[:, None] * corners).sum(axis=0) / forces.sum()
    np.testing.assert_allclose(robot.measured_zmp(), expected)
    for name in FOOT_FORCES:
        data.sensor(f"second/{name}").data[:] = 0.0
    assert np.isnan(robot.measured_zmp()).all()


@pytest.mark.parametrize(
    ("effect", "value"), [("efficiency", 0.9), ("backlash", 0.01)]
)
def test_a_body_that_is_not_ideal_has_realistic_servos(
    effect: str, value: float
) -> None:
    plain, _ = stand()
    assert not isinstance(plain.servos, RealisticServos)
    assert plain.world.before_step == []
    effects: dict[str, Any] = {effect: value}
    robot, scheme = stand(**effects)
    assert isinstance(robot.servos, RealisticServos)
    assert robot.world.before_step == [robot.servos.before_step]
    legs = np.array([n in NAO.legs for n in scheme.kinematics.joint_names])
    assert 10 <= legs.sum() < legs.size
    play = 0.5 * value if effect == "backlash" else 0.0
    angles = robot.read().joint_positions
    robot.servos.reset(angles + 0.1)
    robot.servos.before_step(0.0)
    error = command_of(robot) - angles
    np.testing.assert_allclose(error, 0.1 - play * legs)


def test_speed_limits_belong_to_their_joints() -> None:
    changes: list[dict[str, Any]] = [{}, {"efficiency": 0.9}]
    for effects in changes:
        robot, scheme = stand(**effects)
        limits = [NAO.speed_limits[n] for n in scheme.kinematics.joint_names]
        assert len(set(limits)) > 1
        far, commands = robot.read().joint_positions + 1.0, []
        for _ in range(2):
            robot.write(far)
            for effect in 6 * robot.world.before_step:
                effect(0.0)
            commands.append(command_of(robot))
        moved = commands[1] - commands[0]
        np.testing.assert_allclose(moved, 0.012 * np.array(limits))


def test_sensor_errors_use_the_generator_of_the_robot() -> None:
    """Encoders, IMU and feet go through the errors, in their places."""
    effects: dict[str, Any] = {
        "encoder_step": 0.01,
        "gyro_bias": 0.1,
        "accelerometer_bias": 0.5,
        "force_gain_error": 0.2,
    }
    robot, _ = stand(**effects)
    plain, _ = stand()
    # A real spoilt robot measures what another with the same draws does.
    body = BodySettings(**effects)
    other = SensorErrors(body, named_generator(5, "sensors/second"))
    truth, seen = plain.read(), robot.read()
    turn, force, _, loads = other.readings(
        truth.gyro, truth.accelerometer, truth.gyro, truth.foot_forces
    )
    np.testing.assert_allclose(seen.gyro, turn)
    np.testing.assert_allclose(seen.accelerometer, force)
    assert np.abs(seen.accelerometer - truth.accelerometer).max() > 0.01
    np.testing.assert_allclose(seen.foot_forces, loads)
    np.testing.assert_allclose(
        seen.joint_positions, np.round(truth.joint_positions / 0.01) * 0.01
    )


def test_feedback_makes_the_imu_average() -> None:
    """Over the tick: the mean rate is not that at its end."""
    robot, scheme = stand(feedback=True)
    assert isinstance(walk_of(scheme).balance, ClosedLoop)
    robot.read()
    robot.push(Push(2.0, 0.0, 0.0))
    robot.world.step()
    measured = robot.read()
    assert measured.latest_gyro is not None
    assert abs(measured.latest_gyro[1]) > 1.1 * abs(measured.gyro[1]) > 0.0
    plain, open_loop = stand()
    assert isinstance(walk_of(open_loop).balance, OpenLoop)
    assert plain.read().latest_gyro is None
    assert plain.world.before_step == []


def test_pushes_go_to_the_robots_own_torso() -> None:
    robot, scheme = stand()
    robot.push(Push(1.0, 0.0, 0.0))
    first = robot.pusher
    robot.push(Push(2.0, 0.0, 0.0), Push(0.5, 0.0, 0.0))
    assert first is not None and robot.pusher is first
    world = robot.world
    assert world.before_step == [first.before_step]
    world.before_step[0](0.0)
    torso = world.model.body("second/torso").id
    expected = np.zeros((world.model.nbody, 6))
    expected[torso, :2] = 35.0 * np.array([cos(0.9), sin(0.9)])
    np.testing.assert_allclose(world.data.xfrc_applied, expected, atol=1e-6)


def test_a_walker_has_fallen_by_truth_or_estimate() -> None:
    made = walker()
    assert not made.has_fallen
    walk_of(made.scheme).phase = Phase.FALLEN
    assert made.has_fallen
    walk_of(made.scheme).phase = Phase.WALKING
    at, data = made.robot.qpos_slice.start, made.robot.world.data
    data.qpos[at + 3 : at + 7] = (0.5**0.5, 0.5**0.5, 0.0, 0.0)
    mujoco.mj_kinematics(made.robot.world.model, data)
    assert made.has_fallen
