"""Test policies with two joints that share a motor, as NAO's hips do."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("onnxruntime")

from small_policies import write_policy
from stepaside.core.constants import GRAVITY
from stepaside.locomotion.control_settings import LegsSettings
from stepaside.locomotion.policy.policy_legs import PolicyLegs, load_policy
from stepaside.perception.measurement import RobotState
from stepaside.robots.description import load_robot
from stepaside.robots.tree_cache import load_tree
from stepaside.strategies.velocity_set import STILL

HIPS = [0, 6]  # LHipYawPitch and RHipYawPitch
WIDTH, OBSERVED = 47, 11  # of the observation; first joint in it


def test_a_shared_motor_gets_the_mean_of_its_joints_targets(
    tmp_path: Path,
) -> None:
    """Both joints observe its angle."""
    weights, bias = np.zeros((12, WIDTH)), np.zeros(12)
    bias[HIPS] = 0.2, 0.6
    weights[HIPS, [OBSERVED + i for i in HIPS]] = 1.0
    path = write_policy(tmp_path / "a.onnx", weights, bias)
    nao = load_robot("nao")
    contract, network = load_policy(LegsSettings(str(path), "bhuman"), nao)
    legs = PolicyLegs(contract, network, nao, tick=contract.period)
    angles = legs.joint_targets.copy()
    hip = load_tree(nao).motors.index("LHipYawPitch")
    angles[hip] = 0.1
    zero = np.zeros(3)
    still, up = np.zeros_like(angles), np.array([0.0, 0.0, GRAVITY])
    measurement = RobotState(
        0.0, angles, zero, up, np.ones(8), None, joint_velocities=still
    )
    targets = legs.update(measurement, STILL)
    assert targets[hip] == pytest.approx(0.5)
    others = np.arange(angles.size) != hip
    np.testing.assert_array_equal(targets[others], angles[others])
