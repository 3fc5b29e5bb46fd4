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


@pytest.mark.parametrize("direction", Direction)
def test_a_request_becomes_the_velocity_of_the_template(
    direction: Direction,
) -> None:
    """Equations (7) and (8)."""
    request = MotionRequest(Intent(heading=0.5), direction, False)
    velocity = template_velocity(request, GAIT)
    assert velocity == pytest.approx((0.5 * direction.value, 0.0, 0.2))
    slow = MotionRequest(Intent(0.5, 0.5), direction, False)
    assert template_velocity(slow, GAIT) == pytest.approx(
        (0.25 * direction.value, 0.0, 0.2)
    )


@pytest.mark.parametrize("heading", [-3.0, -0.1, 0.5])
def test_a_saturated_request_turns_at_the_rate_of_the_gain(
    heading: float,
) -> None:
    """Equation (6)."""
    request = MotionRequest(Intent(heading), Direction.FORWARD, True)
    turn = 0.4 if heading > 0.0 else -0.4
    assert template_velocity(request, GAIT) == pytest.approx((0.5, 0.0, turn))


def test_standing_is_no_velocity_and_a_turn_on_the_spot_turns() -> None:
    for intent, velocity in (
        (STAND, (0.0, 0.0, 0.0)),
        (Intent(pi, 0.05), (0.025, 0.0, 0.4 * pi)),
    ):
        request = MotionRequest(intent, Direction.FORWARD, False)
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
