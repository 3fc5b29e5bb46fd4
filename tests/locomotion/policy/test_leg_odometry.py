"""Test odometry from the stance foot and the gyro."""

from math import cos, sin
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array, Pose
from stepaside.locomotion.policy.leg_odometry import LegOdometry
from stepaside.perception.measurement import Measurement

PERIOD = 0.02
LEFT, RIGHT = (0.0, 0.1), (0.0, -0.1)  # feet in odometry, in [m]


class FeetInTorso:
    """Kinematics whose joint angles are the feet themselves."""

    def posture(self, joint_positions: Array) -> Any:
        """Both feet in the torso frame."""
        return SimpleNamespace(
            positions_feet_in_torso=joint_positions.reshape(2, 3)
        )


def seen_from(pose: Pose, left_carries: bool) -> Measurement:
    """Feet on the floor, as a torso at a pose sees them."""
    feet = pose.inverse().transform_points(np.array([LEFT, RIGHT]))
    angles = np.column_stack([feet, [-0.7, -0.7]]).ravel()
    forces = np.repeat([1.0, 0.0] if left_carries else [0.0, 1.0], 4)
    nothing = np.zeros(3)
    return Measurement(0.0, angles, nothing, nothing, forces, None)


@pytest.mark.parametrize("left_carries", [True, False])
@pytest.mark.parametrize("turn", [-0.4, 0.0, 1.0])
def test_the_pose_is_that_of_a_torso_over_feet_that_stay(
    left_carries: bool, turn: float
) -> None:
    """On an arc at 0.5 m/s, with the feet where they are."""
    odometry = LegOdometry(FeetInTorso())  # type: ignore[arg-type]
    for i in range(51):
        heading = turn * i * PERIOD
        x = 0.5 * (sin(heading) / turn if turn else i * PERIOD)
        y = 0.5 * ((1.0 - cos(heading)) / turn if turn else 0.0)
        odometry.update(
            seen_from(Pose(x, y, heading), left_carries),
            (0.0, 0.0),
            turn * PERIOD if i else 0.0,
            PERIOD,
        )
    assert odometry.pose == pytest.approx((x, y, heading), abs=1e-9)
    np.testing.assert_allclose(odometry.velocity, [0.5, 0, 0], atol=0.01)
