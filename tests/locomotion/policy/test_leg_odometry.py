"""Test odometry from the loaded soles and the gyro."""

from collections.abc import Callable
from math import cos, sin
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array, Pose
from stepaside.locomotion.policy.leg_odometry import LegOdometry
from stepaside.perception.measurement import RobotState
from stepaside.planning import Foot
from stored_values import compare_stored, summed

PERIOD = 0.02
LEFT, RIGHT = (0.0, 0.1), (0.0, -0.1)  # feet in odometry, in [m]
FRONT, REAR = 0.12, -0.06  # of a sole, in [m]
SOLE = [(x, y) for x in (FRONT, REAR) for y in (0.03, -0.03)]
CORNERS = np.array([*SOLE, *SOLE])


def run(odometry: LegOdometry) -> None:
    """Advance by the reading that was taken."""
    for loop in odometry.loops:
        loop()


class FeetInTorso:
    """Kinematics whose joint angles are the feet themselves."""

    def __init__(self) -> None:
        self.angles, self.com = np.zeros(24), np.array([0.0, 0.0, 0.1])
        self.places, self.axes = np.zeros((2, 3)), np.zeros((2, 3, 3))

    def force_sensors(self) -> Array:
        """Corners of both soles."""
        return CORNERS

    def evaluate(self, joint_positions: Array) -> None:
        """Both feet in the torso frame, from positions and axes."""
        self.angles[:] = joint_positions
        self.run()

    def run(self) -> None:
        """Evaluate at the angles."""
        rows = self.angles.reshape(2, 4, 3)
        self.places[:], self.axes[:] = rows[:, 0], rows[:, 1:]


def begun_with(
    joint_positions: Array, ratio: tuple[float, float] = (1.0, 1.0)
) -> LegOdometry:
    """Return the odometry of a robot that begins with its feet like that."""
    feet: Any = FeetInTorso()
    return LegOdometry(feet, joint_positions, ratio)


def seen_from(pose: Pose, left_carries: bool) -> RobotState:
    """Feet on the floor, as a torso at a pose sees them."""
    places = pose.inverse().transform_points(np.array([LEFT, RIGHT]))
    feet = np.column_stack([places, [-0.7, -0.7]])[:, None]
    axes = np.tile(about_vertical(-pose.theta), (2, 1, 1))
    angles = np.concatenate([feet, axes], axis=1).ravel()
    forces = np.repeat([1.0, 0.0] if left_carries else [0.0, 1.0], 4)
    return sensed(angles, forces)


def sensed(angles: Array, forces: Array) -> RobotState:
    """Return a measurement of joints and feet."""
    nothing = np.zeros(3)
    return RobotState(0.0, angles, nothing, nothing, forces, None)


def about_vertical(angle: float) -> Array:
    """Return a rotation about the vertical."""
    c, s = cos(angle), sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def about_lateral(angle: float) -> Array:
    """Return a rotation about the lateral axis; positive lowers the toes."""
    c, s = cos(angle), sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


@pytest.mark.parametrize("left_carries", [True, False])
@pytest.mark.parametrize("turn", [-0.4, 0.0, 1.0])
def test_the_pose_is_that_of_a_torso_over_feet_that_stay(
    left_carries: bool, turn: float
) -> None:
    """On an arc at 0.5 m/s, with the feet where they are."""
    first = seen_from(Pose(0.0, 0.0, 0.0), left_carries)
    odometry = begun_with(first.joint_positions)
    for i in range(51):
        heading = turn * i * PERIOD
        x = 0.5 * (sin(heading) / turn if turn else i * PERIOD)
        y = 0.5 * ((1.0 - cos(heading)) / turn if turn else 0.0)
        odometry.take(
            seen_from(Pose(x, y, heading), left_carries),
            (0.0, 0.0),
            turn * PERIOD if i else 0.0,
            PERIOD,
        )
        run(odometry)
    assert odometry.pose == pytest.approx((x, y, heading), abs=1e-9)
    np.testing.assert_allclose(odometry.velocity, [0.5, 0, 0], atol=0.01)
    stance, foot = odometry.stance
    assert foot is (Foot.LEFT if left_carries else Foot.RIGHT)
    place = LEFT if left_carries else RIGHT
    assert stance == pytest.approx((*place, 0.0), abs=1e-9)


@pytest.mark.parametrize("turned", [about_vertical, about_lateral])
def test_a_torso_rests_while_its_feet_turn_about_loaded_corners(
    turned: Callable[[float], Array],
) -> None:
    """The toes carry: feet pivot about them, or roll over them."""
    odometry = begun_with(np.zeros(24))
    toes = np.array([FRONT, 0.0, 0.0])
    forces = np.tile([1.0, 1.0, 0.0, 0.0], 2)
    for i in range(26):
        axes = turned(0.01 * i)
        stays = np.array([[*LEFT, -0.7], [*RIGHT, -0.7]]) + toes
        feet = (stays - axes @ toes)[:, None]
        angles = np.concatenate([feet, np.tile(axes, (2, 1, 1))], axis=1)
        odometry.take(sensed(angles.ravel(), forces), (0, 0), 0.0, PERIOD)
        run(odometry)
    assert odometry.pose == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_a_foot_that_lifts_off_between_readings_does_not_count() -> None:
    """The right foot swings ahead while the torso rests over the left one."""
    odometry = begun_with(np.zeros(24))
    axes = np.tile(np.eye(3), (2, 1, 1))
    for swung, right_carries in ((0.0, 1.0), (0.0, 1.0), (0.03, 0.0)):
        feet = np.array([[*LEFT, -0.7], [*RIGHT, -0.7]])
        feet[1, 0] += swung
        angles = np.concatenate([feet[:, None], axes], axis=1).ravel()
        forces = np.repeat([1.0, right_carries], 4)
        odometry.take(sensed(angles, forces), (0.0, 0.0), 0.0, PERIOD)
        run(odometry)
    assert odometry.pose == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_the_pose_is_true_over_feet_that_slip_by_the_ratio() -> None:
    """The feet slip ahead and aside by known shares of the true motion."""
    slip, moved = np.array([0.04, -0.1]), np.array([0.01, 0.003])
    ahead, side = (1.0 / (1.0 - slip)).tolist()
    odometry = begun_with(np.zeros(24), (ahead, side))
    axes = np.tile(np.eye(3), (2, 1, 1))
    for i in range(51):
        feet = np.array([[*LEFT, -0.7], [*RIGHT, -0.7]])
        feet[:, :2] += i * (slip - 1.0) * moved
        angles = np.concatenate([feet[:, None], axes], axis=1).ravel()
        # In the air for two intervals, which the velocity bridges.
        force = 0.0 if i == 45 else 1.0
        odometry.take(
            sensed(angles, np.full(8, force)), (0.0, 0.0), 0.0, PERIOD
        )
        run(odometry)
    pose = odometry.pose
    assert (pose.x, pose.y) == pytest.approx((0.5, 0.15), rel=1e-3)


@pytest.mark.parametrize("stands", [True, False])
def test_a_foot_that_just_landed_counts_a_tenth(stands: bool) -> None:
    """Beside a foot that stands; alone it carries the torso."""
    odometry = begun_with(np.zeros(24))
    axes = np.tile(np.eye(3), (2, 1, 1))
    slides = [0.0, 0.0, 0.0, 0.01]
    for slid, lands in zip(slides, [0.0, 0.0, 1.0, 1.0], strict=True):
        feet = np.array([[*LEFT, -0.7], [*RIGHT, -0.7]])
        feet[1, 0] += slid
        angles = np.concatenate([feet[:, None], axes], axis=1).ravel()
        forces = np.repeat([float(stands), lands], 4)
        odometry.take(sensed(angles, forces), (0.0, 0.0), 0.0, PERIOD)
        run(odometry)
    share = 0.1 / 1.1 if stands else 1.0
    assert odometry.pose.x == pytest.approx(-0.01 * share)


def test_random_feet_move_the_torso_as_stored() -> None:
    draw, odometry = np.random.default_rng(11), begun_with(np.zeros(24))
    feet, found = np.array([[*LEFT, -0.7], [*RIGHT, -0.7]]), []
    for i in range(300):
        feet = feet + draw.normal(0.0, 0.004, (2, 3))
        axes = [about_lateral(a) for a in draw.normal(0.0, 0.1, 2)]
        angles = np.concatenate([feet[:, None], np.array(axes)], axis=1)
        forces = draw.random(8) * (draw.random(8) < 0.6)
        tilt, turned = draw.normal(0.0, 0.05, 2).tolist(), 0.01 * sin(0.1 * i)
        told = sensed(angles.ravel(), forces)
        odometry.take(told, (tilt[0], tilt[1]), turned, PERIOD)
        run(odometry)
        found += [odometry.pose, odometry.velocity, odometry.stance]
    compare_stored("numbers.json", "odometry", summed(found), 1e-5)
