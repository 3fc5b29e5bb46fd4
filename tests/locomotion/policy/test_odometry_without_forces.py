"""Test leg odometry of a robot without force sensors in its soles."""

import numpy as np
import pytest

from stepaside.locomotion.policy.leg_odometry import LegOdometry
from stepaside.perception.measurement import RobotState
from stepaside.robots.description import load_robot
from stepaside.robots.forward_kinematics import ForwardKinematics

TICK = 0.02  # [s]


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("stance", ["L", "R"])
def test_the_lower_foot_carries_the_robot(stance: str, sign: float) -> None:
    """As forces on that foot say, while the other one is lifted."""
    forward = ForwardKinematics(load_robot("nao"))
    motors = forward.tree.motors
    swing = "R" if stance == "L" else "L"
    postures = []
    for share in np.linspace(0.0, 1.0, 6):
        angles = np.zeros(len(motors))
        angles[motors.index(f"{stance}HipPitch")] = sign * 0.1 * share
        angles[motors.index(f"{stance}AnklePitch")] = -sign * 0.1 * share
        angles[motors.index(f"{swing}HipPitch")] = -0.5 - sign * 0.2 * share
        angles[motors.index(f"{swing}KneePitch")] = 1.0
        angles[motors.index(f"{swing}AnklePitch")] = -0.5
        postures.append(angles)
    forces = np.zeros(8)
    forces[slice(0, 4) if stance == "L" else slice(4, 8)] = 10.0
    places = []
    for given in (forces, np.full(8, np.nan)):
        odometry = LegOdometry(forward, postures[0])
        for i, angles in enumerate(postures):
            zero = np.zeros(3)
            measured = RobotState(i * TICK, angles, zero, zero, given, None)
            odometry.take(measured, (0.0, 0.0), 0.0, TICK)
            for loop in odometry.loops:
                loop()
        places.append(odometry.pose)
    assert abs(places[0].x) > 0.01
    assert places[1] == pytest.approx(places[0], abs=2e-3)
