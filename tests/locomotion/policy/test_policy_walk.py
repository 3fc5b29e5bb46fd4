"""Test learned legs behind the interface of locomotion."""

from math import pi
from pathlib import Path

import numpy as np
import pytest

from stepaside.core.constants import GRAVITY
from stepaside.locomotion.control_settings import LegsSettings
from stepaside.locomotion.locomotion import MotionRequest, template_velocity
from stepaside.perception.measurement import RobotState
from stepaside.planning import Direction, GaitSettings
from stepaside.robots.description import load_robot
from stepaside.strategies import STAND, Intent
from stepaside.strategies.velocity_set import STILL

GAIT = GaitSettings(speed=0.5, gain=0.4, stride=0.2)


def test_a_request_becomes_the_velocity_of_the_template() -> None:
    """Equations (7) and (8), and (6) of a saturated request."""
    ahead, back = Direction.FORWARD, Direction.BACKWARD
    for intent, direction, saturated, velocity in (
        (Intent(heading=0.5), ahead, False, (0.5, 0.0, 0.2)),
        (Intent(heading=0.5), back, False, (-0.5, 0.0, 0.2)),
        (Intent(0.5, 0.5), ahead, False, (0.25, 0.0, 0.2)),
        (Intent(0.5, 0.5), back, False, (-0.25, 0.0, 0.2)),
        (Intent(pi, 0.05), ahead, False, (0.025, 0.0, 0.4 * pi)),
        (STAND, ahead, False, (0.0, 0.0, 0.0)),
        (Intent(-3.0), ahead, True, (0.5, 0.0, -0.4)),
        (Intent(-0.1), ahead, True, (0.5, 0.0, -0.4)),
        (Intent(0.5), ahead, True, (0.5, 0.0, 0.4)),
    ):
        request = MotionRequest(intent, direction, saturated)
        assert template_velocity(request, GAIT) == pytest.approx(velocity)


def test_contract_and_network_follow_their_files(tmp_path: Path) -> None:
    pytest.importorskip("onnxruntime")
    pytest.importorskip("onnx")
    from legs_robot import nao_on_legs
    from small_policies import write_policy
    from stepaside.locomotion.policy.policy_legs import load_policy

    folder = nao_on_legs(tmp_path / "nao", period="0.02")
    file, path = folder / "robot.toml", folder / "policy.onnx"
    for period, action in (0.02, 0.0), (0.04, 0.5):
        text = file.read_text(encoding="utf-8")
        text = text.replace("period = 0.02", f"period = {period}")
        file.write_text(text, encoding="utf-8")
        weights, bias = np.zeros((4, 3)), np.full(4, action)
        write_policy(path, weights, bias, one=action > 0.0)
        robot = load_robot(folder)
        contract, network = load_policy(LegsSettings(str(path)), robot)
        assert contract.period == period
        assert network.evaluate(np.zeros(3), ())[0].tolist() == bias.tolist()


def test_a_walk_by_headings_decides_at_each_step_another_more_often() -> None:
    legs = pytest.importorskip("stepaside.locomotion.policy.policy_legs")
    for intent, time in (
        (Intent(0.5), GAIT.step_duration),
        (Intent(velocity=STILL), 0.08),
    ):
        assert legs.decision_interval(intent, GAIT) == time
    assert legs.PolicyWalk.heading_delay == legs.PolicyWalk.pose_delay == 0.0
    correction, wanted = np.zeros(3), np.zeros(3)
    for _ in range(1000):  # a robot that is blocked
        legs.learn(
            *(np.array([1.0, -1.0, 0.0]), np.zeros(3)),
            *(np.array([0.1, 0.9]), correction, wanted),
        )
    bound = legs.BOUND
    assert wanted == pytest.approx([1.0 + bound, -1.0 - bound, 0.0])


def test_the_heading_follows_the_gyro_between_decisions(
    tmp_path: Path,
) -> None:
    """The robot stands for 1.5 s, and is then turned by 0.5 rad/s."""
    pytest.importorskip("onnxruntime")
    from small_policies import write_policy
    from stepaside.locomotion.policy.policy_legs import PolicyLegs, load_policy

    path = write_policy(tmp_path / "a.onnx", np.zeros((12, 47)), np.zeros(12))
    nao = load_robot("nao")
    contract, network = load_policy(LegsSettings(str(path), "bhuman"), nao)
    tick, headings = contract.period / 4, []
    legs = PolicyLegs(contract, network, nao, tick=tick)
    angles, up = legs.joint_targets.copy(), np.array([0.0, 0.0, GRAVITY])
    for time in tick * np.arange(round(2.5 / tick)):
        gyro = np.array([0.0, 0.0, 0.5 if time > 1.5 else 0.0])
        legs.update(
            RobotState(
                *(time, angles, gyro, up, np.ones(8), None),
                joint_velocities=np.zeros_like(angles),
            ),
            STILL,
        )
        headings.append(legs.pose.theta)
    late = np.diff(headings)[round(1.6 / tick) :]
    np.testing.assert_allclose(late, 0.5 * tick, rtol=1e-6)
