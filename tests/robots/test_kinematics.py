"""Test joint motion generation by damped pseudo-inverse."""

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ReachError
from stepaside.robots.description import load_robot
from stepaside.robots.leg_kinematics import BodyReference, LegKinematics

STANCE = BodyReference(
    (0.02, 0.0, 0.268), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
)


def state_of(posture: np.ndarray) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = load_robot("nao").compile()
    data = mujoco.MjData(model)
    data.qpos[:] = posture
    mujoco.mj_forward(model, data)
    return model, data


def test_height_out_of_reach_is_refused_with_the_height_in_reach() -> None:
    """At 0.28 m the straight legs are too short."""
    kinematics = LegKinematics(load_robot("nao"), tick=0.004)
    with pytest.raises(ReachError, match=r"0\.28 m; it reaches at most 0\.2"):
        kinematics.stand(STANCE._replace(com=(0.02, 0.0, 0.28)))


def test_reference_that_jumps_is_refused_by_name() -> None:
    kinematics = LegKinematics(load_robot("nao"), tick=0.004)
    kinematics.stand(STANCE)
    jumped = STANCE._replace(left_foot=(0.6, 0.05, 0.0, 0.0))
    with pytest.raises(ReachError, match="cannot follow: left foot x"):
        kinematics.track(jumped)
