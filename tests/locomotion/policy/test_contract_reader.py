"""Test contracts from metadata, robot descriptions and conventions."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("onnxruntime")

from small_policies import JOINTS, METADATA, constant_policy, write_policy
from stepaside.core.errors import PolicyError
from stepaside.locomotion.policy.contract import PolicyContract
from stepaside.locomotion.policy.contract_reader import (
    ContractReading,
    Finding,
    RobotJoints,
    conventions,
    read_contract,
)
from stepaside.locomotion.policy.runner import PolicyNetwork
from stored_values import rows_of


def read(
    path: Path, convention: str = "", entries: Mapping[str, Any] | None = None
) -> ContractReading:
    motors = (*JOINTS, "arm")
    robot = RobotJoints(motors, motors, JOINTS, entries or {})
    return read_contract(PolicyNetwork(path), robot, convention)


def findings(path: Path, **given: Any) -> list[Finding]:
    return read(path, **given).findings


def network_of(path: Path, metadata: Mapping[str, Any], width: int) -> Path:
    shape = len(JOINTS), width
    return write_policy(path, np.zeros(shape), np.zeros(len(JOINTS)), metadata)


def test_holosoma_is_recognised_and_completed(tmp_path: Path) -> None:
    path = constant_policy(tmp_path / "a.onnx")
    entries = {"default_posture": {"knee": 0.6}}
    reading = read(path, entries=entries)
    contract = reading.check()
    assert contract.convention == "holosoma"
    assert contract.joints == JOINTS
    assert contract.stiffness == (40.0, 50.0, 20.0)
    assert contract.default_posture == (0.0, 0.6, 0.0)
    assert contract.command_ranges.forward == (-0.8, 1.0)
    assert contract.command_ranges.turn == (-0.5, 0.5)
    assert reading.sources["stiffness"] == "metadata kp"
    alone = network_of(tmp_path / "b.onnx", {"kp": "1,2,3"}, 3)
    with pytest.raises(PolicyError, match="terms is missing"):
        read(alone, entries=entries).check()


def test_mjlab_metadata_give_the_whole_contract(tmp_path: Path) -> None:
    """Values separated by commas, and terms under the trainer's names."""
    metadata = {
        "joint_names": "hip,knee,ankle",
        "joint_stiffness": "40.0,50.0,20.0",
        "joint_damping": "2.0,3.0,1.0",
        "default_joint_pos": "-0.3,0.6,-0.3",
        "action_scale": "0.5,0.4,0.3",
        "observation_names": "base_ang_vel,projected_gravity,joint_pos,"
        "joint_vel,actions,command",
        "command_names": "twist",
    }
    path = network_of(tmp_path / "a.onnx", metadata, 9 + 9)
    contract = read(path).check()
    assert contract.convention == "mjlab"
    assert contract.action_scale == (0.5, 0.4, 0.3)
    assert [term.name for term in contract.terms][-2:] == [
        "actions",
        "command",
    ]


def test_an_entry_of_the_robot_replaces_metadata(tmp_path: Path) -> None:
    path = constant_policy(tmp_path / "a.onnx")
    entries = {"stiffness": 30.0, "default_posture": 0.0}
    contract = read(path, entries=entries).check()
    assert contract.stiffness == (30.0, 30.0, 30.0)


def test_history_widens_the_input(tmp_path: Path) -> None:
    path = network_of(tmp_path / "a.onnx", METADATA, 5 * 22)
    entries = {"default_posture": 0.0, "history": 5}
    assert not findings(path, entries=entries)
    narrow = findings(path, entries=entries | {"history": 4})
    assert narrow and "110" in narrow[0].text and "88" in narrow[0].text


@pytest.mark.parametrize("name", conventions())
def test_every_convention_is_complete_but_for_the_robot(
    name: str, tmp_path: Path
) -> None:
    """With joints, gains and posture each becomes a contract."""
    own = {"joints": list(JOINTS), "stiffness": 40.0, "damping": 2.0}
    own |= {"default_posture": 0.1}
    if name == "mjlab":
        own |= {"action_scale": 0.5}
    path = network_of(tmp_path / "a.onnx", {}, 22)
    contract = read(path, name, own).contract
    assert isinstance(contract, PolicyContract)
    assert contract.observation_width >= 18
    assert conventions()[name].source.startswith("https://")


def test_a_convention_knows_what_differs_for_a_robot(tmp_path: Path) -> None:
    """MuJoCo Playground stops the clock of T1 while it stands."""
    entries = {"stiffness": 40.0, "damping": 2.0, "default_posture": 0.0}
    path = network_of(tmp_path / "a.onnx", {}, 22)
    t1 = entries | {"joints": [*JOINTS, "AAHead_yaw"]}
    contracts = [
        read(path, "mujoco_playground", own).contract for own in (entries, t1)
    ]
    assert [each and each.action_scale[0] for each in contracts] == [0.5, 1.0]
    clocks = [each and each.clock for each in contracts]
    assert [clock and clock.standing for clock in clocks] == ["runs", "holds"]


def test_linear_velocity_is_dropped_where_the_input_says_so(
    tmp_path: Path,
) -> None:
    entries = {"stiffness": 40.0, "damping": 2.0, "default_posture": 0.0}
    for width, count in ((21, 7), (18, 6)):
        path = network_of(tmp_path / f"{width}.onnx", {}, width)
        contract = read(path, "isaac_lab", entries).contract
        assert contract is not None
        assert len(contract.terms) == count
        assert contract.observation_width == width
        assert contract.joints == JOINTS  # assumed: the leg joints


def test_legged_gym_reads_the_deployment_file(tmp_path: Path) -> None:
    pytest.importorskip("yaml")
    path = network_of(tmp_path / "motion.onnx", {}, 20)
    (tmp_path / "motion.yaml").write_text(
        "kps: [100, 150, 40]\nkds: [2, 4, 2]\n"
        "default_angles: [-0.1, 0.3, -0.2]\n"
        "ang_vel_scale: 0.25\ndof_pos_scale: 1.0\ndof_vel_scale: 0.1\n"
        "action_scale: 0.25\ncmd_scale: [2.0, 2.0, 0.25]\n"
        "simulation_dt: 0.002\ncontrol_decimation: 10\n"
    )
    contract = read(path, "legged_gym").check()
    assert contract.stiffness == (100.0, 150.0, 40.0)
    assert contract.period == 0.02
    scales = {term.name: term.scale for term in contract.terms}
    assert scales["joint_vel"] == (0.1,)
    assert scales["command"] == (2.0, 2.0, 0.25)


def test_a_converted_network_contains_its_contract(tmp_path: Path) -> None:
    entries: dict[str, Any] = {"convention": "booster_gym"}
    entries |= {"stiffness": [9.0, 8.0, 7.0]}
    entries |= {"damping": 1.0, "default_posture": 0.0, "action_clip": 2.0}
    metadata = {"stepaside_contract": entries}
    path = network_of(tmp_path / "a.onnx", metadata, 20)
    contract = read(path).check()
    assert contract.convention == "booster_gym"
    assert contract.stiffness == (9.0, 8.0, 7.0)
    assert contract.action_clip == 2.0
    robot = {"stiffness": 5.0}
    assert read(path, "", robot).check().stiffness == (5.0,) * 3
    for wrong in ("[1]", {"gain": 1}):
        changed = {"stepaside_contract": wrong}
        path = network_of(tmp_path / "b.onnx", changed, 20)
        with pytest.raises(PolicyError, match="stepaside_contract"):
            read(path).check()


def test_booster_gym_moves_the_last_joints_of_its_file(tmp_path: Path) -> None:
    pytest.importorskip("yaml")
    path = network_of(tmp_path / "legs.onnx", {}, 20)
    (tmp_path / "legs.yaml").write_text(
        "common: {dt: 0.005, stiffness: [1, 2, 3, 4], damping: [5, 6, 7, 8],"
        " default_qpos: [0.1, 0.2, 0.3, 0.4]}\n"
        "policy: {num_actions: 3, normalization: {gravity: 1, lin_vel: 2,"
        " ang_vel: 3, dof_pos: 1, dof_vel: 0.1, clip_actions: 1.5},"
        " control: {action_scale: 0.5, decimation: 4}}\n"
    )
    contract = read(path, "booster_gym").check()
    assert contract.stiffness == (2.0, 3.0, 4.0)
    assert contract.default_posture == (0.2, 0.3, 0.4)
    assert (contract.action_clip, contract.period) == (1.5, 0.02)
    scales = {term.name: term.scale for term in contract.terms}
    assert scales["command"] == (2.0, 2.0, 3.0)


def test_a_malformed_deployment_file_is_named(tmp_path: Path) -> None:
    pytest.importorskip("yaml")
    path = network_of(tmp_path / "motion.onnx", {}, 20)
    (tmp_path / "motion.yaml").write_text("kps: [1, 2\n")
    with pytest.raises(PolicyError, match="motion.yaml"):
        read(path, "legged_gym")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"kp": [1.0, 1.0, 1.0], "kd": [-0.0] * 3}, ("stiffness", "-0")),
        ({"kp": [40.0, 0.0, 20.0]}, ("stiffness is 0",)),
        ({"action_scale": [0.0, 1.0, 1.0]}, ("action_scale is 0",)),
    ],
)
def test_implausible_values_are_named(
    changes: dict[str, Any], words: tuple[str, ...], tmp_path: Path
) -> None:
    path = constant_policy(tmp_path / "a.onnx", **changes)
    found = findings(path, entries={"default_posture": 0.0})
    assert found and all(f.severity == "warning" for f in found)
    for word in words:
        assert any(word in finding.text for finding in found)


def test_a_missing_value_is_named(tmp_path: Path) -> None:
    path = constant_policy(tmp_path / "a.onnx")
    with pytest.raises(PolicyError, match="default_posture is missing"):
        read(path).check()


def test_a_joint_that_the_robot_lacks_is_named(tmp_path: Path) -> None:
    network = PolicyNetwork(constant_policy(tmp_path / "a.onnx"))
    robot = RobotJoints(JOINTS[:2], JOINTS[:2], (), {"default_posture": 0.0})
    with pytest.raises(PolicyError, match="no joint 'ankle'"):
        read_contract(network, robot).check()


@pytest.mark.parametrize(
    ("entries", "message"), rows_of("test_a_bad_entry_is_named")
)
def test_a_bad_entry_is_named(
    entries: dict[str, Any], message: str, tmp_path: Path
) -> None:
    path = constant_policy(tmp_path / "a.onnx")
    entries = {"default_posture": 0.0} | entries
    with pytest.raises(PolicyError, match=message):
        read(path, entries=entries).check()


def test_an_unknown_convention_is_named(tmp_path: Path) -> None:
    path = constant_policy(tmp_path / "a.onnx")
    with pytest.raises(PolicyError, match="must be one of .*holosoma"):
        read(path, "my_trainer")


def test_malformed_metadata_are_named(tmp_path: Path) -> None:
    path = constant_policy(tmp_path / "a.onnx", kp="stiff")
    with pytest.raises(PolicyError, match="stiffness .*'stiff' .metadata kp"):
        read(path).check()


def test_the_model_fills_in_what_is_missing(tmp_path: Path) -> None:
    """Never in place of what the network brings."""
    path = constant_policy(tmp_path / "a.onnx")
    values = dict(zip((*JOINTS, "arm"), (0.1, 0.2, 0.3, 0.4), strict=True))
    published = {"default_posture": values, "stiffness": values}
    robot = RobotJoints(JOINTS, JOINTS, JOINTS, {}, published)
    reading = read_contract(PolicyNetwork(path), robot)
    contract = reading.check()
    assert contract.default_posture == (0.1, 0.2, 0.3)
    assert reading.sources["default_posture"] == "model"
    assert contract.stiffness == (40.0, 50.0, 20.0)
