"""Test the evaluation of walking policies."""

from dataclasses import replace
from math import cos, pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("onnxruntime")

from small_policies import JOINTS, write_policy
from stepaside.core.errors import PolicyError
from stepaside.core.poses import Array
from stepaside.locomotion.policy.contract import (
    ObservationTerm,
    PhaseClock,
    PolicyContract,
)
from stepaside.locomotion.policy.runner import (
    BodyMotion,
    PolicyNetwork,
    PolicyRunner,
    TensorShape,
)

Term = ObservationTerm
CONTRACT = PolicyContract(
    convention="test",
    joints=JOINTS,
    terms=(Term("joint_pos"),),
    default_posture=(0.1, 0.2, 0.3),
    stiffness=(1.0, 1.0, 1.0),
    damping=(0.1, 0.1, 0.1),
    action_scale=(0.5, 0.5, 0.5),
)
STILL, AHEAD = np.zeros(3), np.array([0.5, 0.0, 0.0])


def body(**changes: Any) -> dict[str, Any]:
    """Return a measured state, as fields of the motion."""
    values = {
        "joint_positions": CONTRACT.default_posture,
        "joint_velocities": np.zeros(3),
        "angular_velocity": np.zeros(3),
        "up": (0.0, 0.0, 1.0),
        "velocity": np.zeros(3),
    }
    return values | changes


class Walker:
    """Runner whose observations are evaluated at once."""

    def __init__(
        self, contract: PolicyContract, network: PolicyNetwork
    ) -> None:
        self._motion = BodyMotion(*np.zeros((6, 3)))
        self.runner = PolicyRunner(contract, network, self._motion, range(3))
        self.network = network

    def update(self, body: dict[str, Any], command: Array) -> Array:
        """Return the targets of one control period."""
        for name, value in (body | {"command": command}).items():
            getattr(self._motion, name)[:] = value
        self.runner.loop()
        seen = self.runner.observation()
        answer = self.network.evaluate(seen, self.runner.memory)
        return self.runner.act(*answer)


def echo(path: Path, contract: PolicyContract, first: int = 0) -> Walker:
    """Policy whose actions repeat three values of its observation."""
    width = contract.observation_width
    weights = np.eye(3, width, k=first)
    file = write_policy(path / "echo.onnx", weights, np.zeros(3))
    return Walker(contract, PolicyNetwork(file))


def action_of(targets: Array) -> Array:
    """Action behind joint targets of the contract above."""
    action: Array = (targets - np.array(CONTRACT.default_posture)) / 0.5
    return action


def test_targets_are_scaled_actions_about_the_default_posture(
    tmp_path: Path,
) -> None:
    runner = echo(tmp_path, CONTRACT)
    angles = np.array([0.2, 0.0, 0.3])
    targets = runner.update(body(joint_positions=angles), STILL)
    np.testing.assert_allclose(
        targets, [0.1 + 0.5 * 0.1, 0.2 - 0.5 * 0.2, 0.3], atol=1e-7
    )


def test_terms_are_clipped_then_scaled(tmp_path: Path) -> None:
    term = Term("base_ang_vel", (2.0,), clip=1.0)
    runner = echo(tmp_path, replace(CONTRACT, terms=(term,)))
    rates = np.array([0.5, -3.0, 1.5])
    targets = runner.update(body(angular_velocity=rates), STILL)
    np.testing.assert_allclose(action_of(targets), [1.0, -2.0, 2.0], atol=1e-6)


@pytest.mark.parametrize(("order", "at"), [("term", 3), ("frame", 6)])
def test_the_oldest_observation_is_first(
    order: Any, at: int, tmp_path: Path
) -> None:
    """The first observation fills the history."""
    contract = replace(
        CONTRACT,
        terms=(Term("command"), Term("base_ang_vel")),
        history=2,
        history_order=order,
    )
    for place, expected in ((0, STILL), (at, AHEAD)):
        runner = echo(tmp_path, contract, place)
        runner.update(body(), STILL)
        targets = runner.update(body(), AHEAD)
        np.testing.assert_allclose(action_of(targets), expected, atol=1e-6)


@pytest.mark.parametrize("clipped", [True, False])
def test_the_previous_action_is_observed(
    clipped: bool, tmp_path: Path
) -> None:
    """After clipping, or as the network returned it."""
    contract = replace(
        CONTRACT,
        terms=(Term("actions"), Term("command")),
        action_clip=1.0,
        observes_clipped=clipped,
    )
    weights = np.zeros((3, 6))
    weights[0, 3] = 8.0  # action 0 is eight times the commanded velocity
    weights[1, 0] = 0.1  # action 1 is a tenth of the previous action 0
    file = write_policy(tmp_path / "a.onnx", weights, np.zeros(3))
    runner = Walker(contract, PolicyNetwork(file))
    first = action_of(runner.update(body(), AHEAD))
    assert first[0] == pytest.approx(1.0)
    second = action_of(runner.update(body(), AHEAD))
    assert second[1] == pytest.approx(0.1 if clipped else 0.4)


def phases(
    tmp_path: Path, clock: PhaseClock, commands: list[Array]
) -> list[list[float]]:
    """Cosines of both phases over some control periods."""
    contract = replace(
        CONTRACT, terms=(Term("cos_phase"), Term("command")), clock=clock
    )
    runner = echo(tmp_path, contract)
    return [action_of(runner.update(body(), c))[:2].tolist() for c in commands]


def test_a_clock_holds_while_standing_and_starts_anew(tmp_path: Path) -> None:
    clock = PhaseClock(period=0.08, standing="holds")
    seen = phases(tmp_path, clock, [STILL, STILL, AHEAD, AHEAD, STILL, AHEAD])
    expected = [[-1, -1], [-1, -1], [1, -1], [0, 0], [-1, -1], [1, -1]]
    np.testing.assert_allclose(seen, expected, atol=1e-6)


def test_a_clock_still_runs_until_the_robot_has_settled(
    tmp_path: Path,
) -> None:
    clock = PhaseClock(period=0.08, standing="silent", settling=0.04)
    seen = phases(tmp_path, clock, [STILL, AHEAD, STILL, STILL, STILL, AHEAD])
    expected = [[0, 0], [1, -1], [0, 0], [-1, 1], [0, 0], [1, -1]]
    np.testing.assert_allclose(seen, expected, atol=1e-6)


def test_the_last_output_changes_the_frequency_of_the_clock(
    tmp_path: Path,
) -> None:
    """By 2.5 /s at most: from 12.5 to 15 cycles per second."""
    clock = PhaseClock(period=0.08, offsets=(0.0,), spread=2.5)
    contract = replace(
        CONTRACT,
        terms=(Term("cos_phase"), Term("frequency")),
        action_clip=4.0,
        clock=clock,
    )
    weights = np.zeros((4, 2))
    weights[[0, 1], [0, 1]] = 1.0
    file = write_policy(tmp_path / "a.onnx", weights, np.array([0, 0, 0, 9.0]))
    walker = Walker(contract, PolicyNetwork(file))
    seen = [
        action_of(walker.update(body(), AHEAD))[:2].tolist() for _ in range(3)
    ]
    phases = [0.25, 0.55, 0.85]  # of a cycle
    cosines = [cos(2.0 * pi * phase) for phase in phases]
    expected = [[c, f] for c, f in zip(cosines, (0.0, 4.0, 4.0), strict=True)]
    np.testing.assert_allclose(seen, expected, atol=1e-6)
    assert contract.action_width == 4


def test_commands_change_at_a_limited_rate(tmp_path: Path) -> None:
    contract = replace(CONTRACT, terms=(Term("command"),), command_rate=1.0)
    runner = echo(tmp_path, contract)
    seen = [action_of(runner.update(body(), AHEAD))[0] for _ in range(30)]
    assert seen[0] == pytest.approx(0.02)
    assert seen[-1] == pytest.approx(0.5)


def test_a_filter_keeps_a_share_of_the_last_targets(tmp_path: Path) -> None:
    contract = replace(CONTRACT, terms=(Term("command"),), action_filter=0.8)
    runner = echo(tmp_path, contract)
    targets = runner.update(body(), AHEAD)
    np.testing.assert_allclose(action_of(targets), 0.2 * AHEAD, atol=1e-6)


def test_a_recurrent_state_is_fed_back(tmp_path: Path) -> None:
    """The state counts evaluations, and a new runner resets it."""
    file = write_policy(
        tmp_path / "a.onnx", np.zeros((3, 3)), np.zeros(3), states=2
    )
    network = PolicyNetwork(file)
    assert [given.name for given, _ in network.states] == ["h_in"]
    for _ in range(2):
        runner = Walker(CONTRACT, network)
        seen = [action_of(runner.update(body(), STILL)) for _ in range(3)]
        np.testing.assert_allclose(
            seen, [[0, 0, 0], [1, 1, 0], [2, 2, 0]], atol=1e-6
        )


@pytest.mark.parametrize("value", [np.nan, -np.inf, 1e30])
def test_an_output_that_is_not_finite_is_named(
    value: float, tmp_path: Path
) -> None:
    file = write_policy(
        tmp_path / "a.onnx", np.zeros((3, 3)), np.array([0.0, value, 0.0])
    )
    with pytest.raises(PolicyError, match="output 1 .* must be finite"):
        PolicyNetwork(file)


def test_an_output_that_grows_beyond_reason_ends_a_walk(
    tmp_path: Path,
) -> None:
    file = write_policy(tmp_path / "a.onnx", np.eye(3), np.zeros(3))
    network = PolicyNetwork(file)
    with pytest.raises(PolicyError, match="output 1 .* must be finite"):
        network.evaluate(np.array([0.0, 2e4, 0.0]), ())


@pytest.mark.parametrize("shape", [[3, 1], [3], [None, 3], [3, None]])
def test_the_width_is_the_axis_with_values(shape: list[int | None]) -> None:
    assert TensorShape("obs", tuple(shape)).width == 3


def test_an_action_is_found_by_its_name(tmp_path: Path) -> None:
    """An estimate of the value of a state may come before it."""
    onnx = pytest.importorskip("onnx")
    file = write_policy(tmp_path / "a.onnx", np.eye(3), np.zeros(3))
    model = onnx.load(file)
    model.graph.node.append(
        onnx.helper.make_node("ReduceSum", ["obs"], ["value"], keepdims=1)
    )
    real = onnx.TensorProto.FLOAT
    value = onnx.helper.make_tensor_value_info("value", real, [1, 1])
    model.graph.output.insert(0, value)
    onnx.save(model, file)
    action, _ = PolicyNetwork(file).evaluate(np.array([1.0, 2.0, 3.0]), ())
    np.testing.assert_array_equal(action, [1.0, 2.0, 3.0])


def test_outputs_that_are_alike_are_told_by_the_name_only(
    tmp_path: Path,
) -> None:
    onnx = pytest.importorskip("onnx")
    file = write_policy(tmp_path / "a.onnx", np.eye(3), np.zeros(3))
    model = onnx.load(file)
    for name in ("mean", "mode"):
        node = onnx.helper.make_node("Neg", ["obs"], [name])
        model.graph.node.append(node)
    del model.graph.output[:]
    real = onnx.TensorProto.FLOAT
    for name in ("mean", "mode"):
        out = onnx.helper.make_tensor_value_info(name, real, [1, 3])
        model.graph.output.append(out)
    onnx.save(model, file)
    with pytest.raises(PolicyError, match=r"named action, got mean \[1, 3\]"):
        PolicyNetwork(file)


def test_a_file_that_is_no_network_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.onnx"
    path.write_text("no network")
    with pytest.raises(PolicyError, match="a.onnx is not an ONNX network"):
        PolicyNetwork(path)
