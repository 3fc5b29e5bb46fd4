"""Test a simulated robot: sensors, servos, fall and reference point."""

from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.control import ControlScheme
from stepaside.control.sight_sources import MeasuredSight
from stepaside.core.poses import Array, Pose
from stepaside.games.physics_world import RobotSetup, place_robot
from stepaside.games.player_settings import PlayerSettings
from stepaside.games.players import RobotPlayer
from stepaside.locomotion.control_settings import OPEN_LOOP, STABILISED
from stepaside.perception.measurement import Sighting
from stepaside.robots.description import load_robot
from stepaside.robots.description_types import FOOT_FORCES
from stepaside.sim.body_settings import BodySettings
from stepaside.sim.physics_settings import PhysicsSettings
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
) -> RobotPlayer:
    """The second of two robots in a world."""
    body = BodySettings(**effects)
    physics = PhysicsSettings(tick=0.012)
    world = World({"first": NAO, "second": NAO}, physics, body)
    world.data.qpos[:3] = (-9.0, 0.0, 0.33)  # out of the way
    control = STABILISED if feedback else OPEN_LOOP
    made = place_robot(
        world,
        RobotSetup(
            PlayerSettings("second", control=control, start=tuple(frame)),
            NAO,
            body,
            seed=5,
            source=MeasuredSight(Sighting(0.0, 0.2, 2.0)),
            sights=sights,
        ),
        Pursuit(),
    )
    mujoco.mj_forward(world.model, world.data)
    return made


def stand(
    frame: Pose = FRAME, *, feedback: bool = False, **effects: Any
) -> tuple[SimulatedRobot, ControlScheme]:
    """Its body and its control."""
    made = walker(frame, feedback=feedback, **effects)
    return made.robot, made.scheme


def test_a_robot_starts_at_its_odometry_frame() -> None:
    robot, scheme = stand()
    # The torso stands over the feet, on the line between them.
    place = FRAME.inverse().transform_points(
        [robot.truth.position_torso_in_world]
    )[0]
    assert abs(place[0]) < 0.03 and abs(place[1]) < 1e-6
    assert robot.truth.heading_in_world == pytest.approx(FRAME.theta)
    data = robot.world.data
    wanted = scheme.walk.kinematics.posture
    assert robot.qpos_slice.stop - robot.qpos_slice.start == wanted.size
    np.testing.assert_array_equal(data.qpos[robot.qpos_slice][7:], wanted[7:])
    kept = robot.motion()["qpos"].copy()
    np.testing.assert_array_equal(kept, data.qpos[robot.qpos_slice])
    data.qpos[robot.qpos_slice][7] += 1.0
    assert robot.motion()["qpos"][7] == kept[7] + 1.0
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
