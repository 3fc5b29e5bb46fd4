"""Test the state estimator with a given posture."""

from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.core.rotations import rotation
from stepaside.locomotion.zmp.state_estimator import BodyState, StateEstimator
from stepaside.perception.measurement import RobotState
from stepaside.robots.leg_kinematics import BodyReference
from stored_values import compare_stored, summed

ETA, TICK = 6.0, 0.004
GRAVITY = np.array([0.0, 0.0, 9.81])
CORNERS = [(0.09, 0.04), (0.09, -0.03), (-0.05, 0.04), (-0.05, -0.03)]
SENSORS = np.array(CORNERS + [(x, -y) for x, y in CORNERS])
LEVER = np.array([0.03, 0.02, 0.26])  # from the left foot to the CoM
FEET = BodyReference((9.0, 9.0, 0.27), (1.0, 2.0, 0.0, 0.5), (1.0, 1.9, 0, 0))
ZERO = (0.0, 0.0)


class FakeKinematics:
    """A body that stands with its feet where it is told.

    Seen from a frame with the heading of the odometry, the left foot is at
    the origin, the right one at ``apart``, and the CoM at ``lever``.
    """

    def __init__(self) -> None:
        self.mass, self.com = 5.1, np.zeros(3)
        self.places, self.axes = np.zeros((2, 3)), np.zeros((2, 3, 3))
        self.lever = LEVER.copy()
        self.apart = np.array([0.0, -0.1, 0.0])
        self.yaws = (0.5, 0.0)  # of the feet, as the reference has them
        self.torso = rotation(0.0, 0.0, 0.2)

    def evaluate(self, joint_positions: Array) -> None:
        """Set the posture, whatever the joints say."""
        back = self.torso.T
        left = np.array([0.01, 0.05, -0.3])
        self.com[:] = left + back @ self.lever
        self.places[:] = left, left + back @ self.apart
        self.axes[:] = [back @ rotation(0.0, 0.0, yaw) for yaw in self.yaws]


def estimator(body: Any = None, **changes: Any) -> StateEstimator:
    stands: Any = body or FakeKinematics()
    return StateEstimator(stands, SENSORS, ETA, TICK, **changes)


def measured(
    left: Any = 10.0, right: Any = 10.0, felt: Array = GRAVITY
) -> RobotState:
    forces = np.concatenate(
        [np.broadcast_to(left, 4), np.broadcast_to(right, 4)]
    )
    return RobotState(0.0, np.zeros(3), np.zeros(3), felt, forces, None)


def see(
    estimate: StateEstimator,
    measurement: RobotState,
    feet: BodyReference = FEET,
    ticks: int = 1,
) -> BodyState:
    for _ in range(ticks):
        state = estimate.update(measurement, feet, ZERO)
    return state


def test_com_is_over_the_foot_that_bears_the_weight() -> None:
    """By the lever of the joints, turned as the foot stands in odometry.

    So light a body is not pulled by its ZMP: what is measured is seen.
    """
    state = see(estimator(), measured(left=2.0, right=0.0))
    np.testing.assert_allclose(state.com, [1.03, 2.02], atol=1e-12)
    state = see(estimator(), measured(left=0.0, right=2.0))
    # The right foot stands 0.1 m to the right of the left one.
    np.testing.assert_allclose(state.com, [1.03, 2.02], atol=1e-12)


@pytest.mark.parametrize("tilt", [(0.71, 0.0), (0.0, -0.71), (-0.69, 0.69)])
def test_a_robot_that_leans_beyond_40_degrees_has_fallen(
    tilt: tuple[float, float],
) -> None:
    state = see(estimator(), measured())._replace(tilt=tilt)
    assert state.has_fallen == (max(np.abs(tilt)) > 0.7)


def test_heading_of_the_torso_is_that_over_the_foot_that_stands() -> None:
    """It stands turned by 0.2 rad; the right foot has slipped by 0.1 rad."""
    feet = FEET._replace(right_foot=(1.0, 1.9, 0.0, 0.1))
    for left, heading in ((9.0, 0.2), (1.0, 0.3)):
        estimate = estimator()
        assert estimate.torso_heading == 0.0
        see(estimate, measured(left, 10.0 - left), feet)
        assert estimate.torso_heading == pytest.approx(heading)


@pytest.mark.parametrize("tilt", [(0.2, 0.0), (0.0, 0.3), (-0.2, 0.25)])
def test_a_tilt_of_the_torso_leans_the_com(tilt: tuple[float, float]) -> None:
    """Joints say the same, but the IMU says that all of it leans."""
    body = FakeKinematics()
    body.torso = lean = rotation(*tilt, 0.2)
    estimate = estimator(body)
    felt = lean.T @ GRAVITY
    light = measured(left=1.0, right=1.0, felt=felt)
    state = see(estimate, light, ticks=400)
    assert estimate.ready
    assert state.tilt == pytest.approx(tilt, abs=1e-9)
    np.testing.assert_allclose(state.com, [1.03, 2.02], atol=1e-6)


def test_zmp_is_the_center_of_the_forces() -> None:
    """A foot pressed at one corner, in its own axes, at its place."""
    for corner in range(4):
        press = np.eye(4)[corner] * 40.0
        state = see(estimator(), measured(left=press, right=0.0))
        turned = rotation(0.0, 0.0, 0.5)[:2, :2] @ SENSORS[corner]
        np.testing.assert_allclose(state.zmp, turned + [1.0, 2.0])
        state = see(estimator(), measured(left=0.0, right=press))
        expected = SENSORS[4 + corner] + [1.0, 1.9]
        np.testing.assert_allclose(state.zmp, expected)


def test_dcm_is_ahead_of_the_com_by_its_velocity() -> None:
    body = FakeKinematics()
    estimate = estimator(body)
    for i in range(40):
        body.lever = LEVER + (0.001 * i, -0.002 * i, 0.0)
        state = see(estimate, measured())
    assert state.velocity[0] > 0.1 > -0.1 > state.velocity[1]
    expected = np.add(state.com, np.divide(state.velocity, ETA))
    np.testing.assert_allclose(state.dcm, expected)


def test_a_falling_pendulum_is_followed_without_lag() -> None:
    """Its ZMP tells its acceleration."""
    body = FakeKinematics()
    estimate = estimator(body)
    press = np.full(4, 15.0)  # in the middle of the left foot
    local = SENSORS[:4].mean(axis=0)
    pivot = rotation(0.0, 0.0, 0.5)[:2, :2] @ local + [1.0, 2.0]
    start = np.array([0.004, -0.002])
    for i in range(150):
        off = start * np.cosh(ETA * i * TICK)
        body.lever = np.array([*(pivot + off - [1.0, 2.0]), 0.26])
        state = see(estimate, measured(left=press, right=0.0))
    speed = start * ETA * np.sinh(ETA * 149 * TICK)
    np.testing.assert_allclose(state.com - pivot, off, rtol=1e-3)
    np.testing.assert_allclose(state.velocity, speed, rtol=5e-3)


def test_without_contact_the_pendulum_has_no_force() -> None:
    """Below ten newtons the ZMP says nothing."""
    for force, moves in ((1.1, False), (1.4, True)):
        estimate = estimator()
        state = see(estimate, measured(left=force, right=force), ticks=2)
        moved = np.abs(state.velocity).max() > 1e-6
        assert moved == moves


def test_commanded_acceleration_is_not_mistaken_for_tilt() -> None:
    """Asked in odometry, felt in the torso, which is turned by 0.2 rad."""
    estimate = estimator()
    see(estimate, measured(), ticks=260)
    asked = (1.0, -0.5)
    felt = GRAVITY + rotation(0.0, 0.0, 0.2).T @ (*asked, 0.0)
    for _ in range(200):
        state = estimate.update(measured(felt=felt), FEET, asked)
    assert state.tilt == pytest.approx((0.0, 0.0), abs=1e-9)


def test_estimates_of_random_measurements_are_as_stored() -> None:
    draw, body = np.random.default_rng(3), FakeKinematics()
    estimate, found = estimator(body), []
    for _ in range(400):
        body.lever = LEVER + draw.normal(0.0, 0.02, 3)
        body.torso = rotation(0.1 * draw.normal(), 0.1 * draw.normal(), 0.2)
        forces = draw.uniform(0.0, 20.0, 8) * (draw.random(8) < 0.7)
        forces[:4] *= draw.random() < 0.7
        felt = GRAVITY + draw.normal(0.0, 0.3, 3)
        told = measured(forces[:4], forces[4:], felt)
        told = told._replace(gyro=draw.normal(0.0, 0.2, 3))
        rest = draw.normal(0.0, 0.1, (2, 2)).tolist()
        found.append(estimate.update(told, FEET, *map(tuple, rest)))
    compare_stored("numbers.json", "estimator", summed(found), 1e-5)
