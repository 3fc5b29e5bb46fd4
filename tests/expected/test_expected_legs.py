"""What was once wrong with learned legs."""

import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("onnxruntime")
onnx = pytest.importorskip("onnx")

import stepaside as sa  # noqa: E402
from expected.asking import refused  # noqa: E402
from flows.calls import stepaside  # noqa: E402
from small_policies import (  # noqa: E402
    JOINTS,
    constant_policy,
    write_policy,
)
from stepaside.locomotion.policy.runner import (  # noqa: E402
    PolicyNetwork,
)
from stepaside.strategies.learned import (  # noqa: E402
    LearnedStrategy,
    StrategyContract,
    dense_network,
)

NAO = Path(sa.__file__).parent / "robots" / "nao"
MJLAB = {
    "joint_names": "hip,knee,ankle",
    "joint_stiffness": "40.0,50.0,20.0",
    "joint_damping": "2.0,3.0,1.0",
    "default_joint_pos": "-0.3,0.6,-0.3",
    "action_scale": "0.5,0.4,0.3",
    "observation_names": "base_ang_vel,projected_gravity,joint_pos,"
    "joint_vel,actions,command",
}


def mjlab(path: Path, **more: str) -> Path:
    shape = len(JOINTS), 18
    return write_policy(
        path, np.zeros(shape), np.zeros(len(JOINTS)), MJLAB | more
    )


def external(network: Path) -> Path:
    """Move the weights to a file beside a network, as PyTorch does."""
    onnx.save(
        onnx.load(network),
        network,
        save_as_external_data=True,
        location=f"{network.name}.data",
        size_threshold=0,
    )
    return network


@pytest.mark.parametrize("key", ["observation_terms_delay", "gains"])
def test_metadata_that_are_not_read_are_named(
    key: str, tmp_path: Path
) -> None:
    network = mjlab(tmp_path / "a.onnx", **{key: "1,1,1,1,1,1"})
    facts = stepaside("robot", "legs", "inspect", network, "--json").json
    (finding,) = facts["findings"]
    assert finding["text"] == f"metadata key '{key}' is not read"


def test_properties_of_observations_are_those_of_the_metadata(
    tmp_path: Path,
) -> None:
    network = mjlab(
        tmp_path / "a.onnx",
        observation_terms_scale="0.250,1.000,1.000,0.050,1.000,2.0;2.0;0.25",
        observation_terms_clip="-5.0;5.0,-inf;inf,-inf;inf,-inf;inf,"
        "-inf;inf,-inf;inf",
        observation_terms_history_length="0,0,0,0,0,0",
        observation_terms_flatten_history_dim="1,1,1,1,1,0",
        run_path="me/run",
    )
    facts = stepaside("robot", "legs", "inspect", network, "--json").json
    assert not facts["findings"]
    terms = facts["contract"]["terms"]
    scales = [[0.25], [1.0], [1.0], [0.05], [1.0], [2.0, 2.0, 0.25]]
    assert [term["scale"] for term in terms] == scales
    assert [term["clip"] for term in terms] == [5.0, *5 * [None]]


def test_a_history_is_that_of_the_metadata(tmp_path: Path) -> None:
    """An axis of its own for the past is refused."""
    given = MJLAB | {"observation_terms_history_length": "5,5,5,5,5,5"}
    zeros = np.zeros((len(JOINTS), 5 * 18)), np.zeros(len(JOINTS))
    network = tmp_path / "a.onnx"
    write_policy(network, *zeros, given)
    facts = stepaside("robot", "legs", "inspect", network, "--json").json
    assert not facts["findings"] and facts["contract"]["history"] == 5
    given["observation_terms_flatten_history_dim"] = "0,0,0,0,0,1"
    write_policy(network, *zeros, given)
    said = refused("robot", "legs", "inspect", network)
    assert "observation_terms_flatten_history_dim" in said


@pytest.mark.parametrize(
    "key", ["observation_history_lengths", "observation_terms_history_length"]
)
def test_unequal_histories_are_refused_by_name(
    key: str, tmp_path: Path
) -> None:
    network = mjlab(tmp_path / "a.onnx", **{key: "1,1,1,5,1,1"})
    assert key in refused("robot", "legs", "inspect", network)


def test_nested_metadata_are_refused_in_one_line(tmp_path: Path) -> None:
    deep = "[" * 100_000 + "]" * 100_000
    network = constant_policy(tmp_path / "a.onnx", kp=deep)
    assert "'kp'" in refused("robot", "legs", "inspect", network)


def test_a_nested_deployment_file_is_refused_in_one_line(
    tmp_path: Path,
) -> None:
    network = constant_policy(tmp_path / "a.onnx")
    deep = "[" * 5000 + "]" * 5000
    (tmp_path / "a.yaml").write_text(deep, encoding="utf-8")
    said = refused(
        "robot", "legs", "inspect", network, "--legs-contract", "legged_gym"
    )
    assert "a.yaml" in said


def test_a_clock_that_is_a_number_is_refused_by_name(tmp_path: Path) -> None:
    folder = tmp_path / "nao"
    shutil.copytree(NAO, folder)
    with (folder / "robot.toml").open("a", encoding="utf-8") as file:
        file.write("\n[locomotion]\nclock = 7\n")
    network = constant_policy(tmp_path / "a.onnx")
    said = refused("robot", "legs", "inspect", network, "--robot", folder)
    assert "locomotion.clock" in said


def test_the_reason_why_a_network_cannot_be_read_is_passed_on(
    tmp_path: Path,
) -> None:
    """Of a network whose weights beside it are missing."""
    network = external(constant_policy(tmp_path / "a.onnx"))
    (tmp_path / "a.onnx.data").unlink()
    said = refused("robot", "legs", "inspect", network)
    assert "a.onnx.data" in said or "external" in said


@pytest.mark.parametrize(
    "words", [("robot", "legs", "inspect"), ("run", "game")]
)
@pytest.mark.parametrize("kind", ["pipe", "zeros"])
def test_only_regular_files_are_read(
    words: tuple[str, ...], kind: str, tmp_path: Path
) -> None:
    file = Path("/dev/zero")
    if kind == "pipe":
        file = tmp_path / "pipe"
        os.mkfifo(file)
    assert "not a regular file" in refused(*words, file)


def inspected(network: Path, value: float) -> None:
    """Check that a network is found right, and acts by its observation."""
    assert not stepaside("robot", "legs", "inspect", network, "--json").json[
        "findings"
    ]
    loaded = PolicyNetwork(network)
    seen = np.full(18, value)
    for factor in (1.0, 2.0):
        actions, _ = loaded.evaluate(factor * seen, loaded.initial_memory())
        np.testing.assert_allclose(actions, 18.0 * factor * value)


@pytest.mark.parametrize("kind", ["FLOAT16", "DOUBLE"])
def test_a_network_may_compute_with_other_numbers(
    kind: str, tmp_path: Path
) -> None:
    network = tmp_path / "a.onnx"
    shape = len(JOINTS), 18
    write_policy(network, np.ones(shape), np.zeros(len(JOINTS)), MJLAB)
    model = onnx.load(network)
    number = getattr(onnx.TensorProto, kind)
    for port in (*model.graph.input, *model.graph.output):
        port.type.tensor_type.elem_type = number
    for i, tensor in enumerate(model.graph.initializer):
        values = onnx.numpy_helper.to_array(tensor)
        values = values.astype(onnx.helper.tensor_dtype_to_np_dtype(number))
        model.graph.initializer[i].CopyFrom(
            onnx.numpy_helper.from_array(values, tensor.name)
        )
    onnx.save(model, network)
    inspected(network, 0.25)


@pytest.mark.parametrize("axes", [0, 2, 3])
@pytest.mark.parametrize("first", [True, False])
def test_an_observation_may_have_one_to_three_axes(
    axes: int, first: bool, tmp_path: Path
) -> None:
    """Of which any may be that of the walkers, and open."""
    network = tmp_path / "a.onnx"
    shape = len(JOINTS), 18
    write_policy(network, np.ones(shape), np.zeros(len(JOINTS)), MJLAB)
    model, node = onnx.load(network), onnx.helper.make_node
    for port in (model.graph.input[0], model.graph.output[0]):
        sizes = port.type.tensor_type.shape.dim
        width = sizes[1].dim_value
        del sizes[:]
        for _ in range(max(axes - 1, 0)):
            sizes.add().dim_value = 1
        if axes:
            sizes[0 if first else -1].dim_param = "walkers"
        sizes.add().dim_value = width
    del model.graph.node[:]
    model.graph.node.append(node("MatMul", ["obs", "weights"], ["actions"]))
    onnx.save(model, network)
    inspected(network, 0.5)


def test_weights_may_be_in_a_file_beside_the_network(tmp_path: Path) -> None:
    network = external(mjlab(tmp_path / "a.onnx"))
    assert not stepaside("robot", "legs", "inspect", network, "--json").json[
        "findings"
    ]


def test_weights_of_a_strategy_may_lie_beside_it(tmp_path: Path) -> None:
    contract = StrategyContract(
        sa.Direction.BACKWARD, ("bearing",), (0.0, None)
    )
    network = tmp_path / "a.onnx"
    layer = np.zeros((2, 2)), np.zeros(2)
    LearnedStrategy(dense_network([layer]), contract).save(network)
    words = "duel", "--set", "level=steps", "--duration", 1, "--strategy"
    stepaside(*words, network)
    stepaside(*words, external(network))


def test_a_network_that_draws_is_named(tmp_path: Path) -> None:
    network = mjlab(tmp_path / "a.onnx")
    model = onnx.load(network)
    nodes, node = model.graph.node, onnx.helper.make_node
    nodes[0].output[0] = "plain"
    nodes.append(node("RandomNormalLike", ["plain"], ["noise"], dtype=1))
    nodes.append(node("Add", ["plain", "noise"], ["actions"]))
    onnx.save(model, network)
    (finding,) = stepaside("robot", "legs", "inspect", network, "--json").json[
        "findings"
    ]
    assert "random" in finding["text"]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ("opset", "opset"),
        ("operator", "acme:Own"),
        ("cut", "parsing failed"),
        ("rank", "rank"),
    ],
)
def test_the_reason_of_the_runtime_is_passed_on(
    change: str, reason: str, tmp_path: Path
) -> None:
    network = mjlab(tmp_path / "a.onnx")
    model = onnx.load(network)
    match change:
        case "opset":
            model.opset_import[0].version = 99
        case "operator":
            model.graph.node[0].op_type = "Own"
            model.graph.node[0].domain = "acme"
            model.opset_import.append(onnx.helper.make_opsetid("acme", 1))
        case "rank":
            for port in (*model.graph.input, *model.graph.output):
                port.type.tensor_type.shape.dim.add().dim_value = 1
    onnx.save(model, network)
    if change == "cut":
        network.write_bytes(network.read_bytes()[:200])
    assert reason in refused("robot", "legs", "inspect", network)


def two_states(
    network: Path,
    inputs: str = "obs h_in c_in",
    outputs: str = "actions h_out c_out",
    kind: str = "FLOAT",
) -> Path:
    """Write a network of two recurrent states, h counting, c at rest.

    Args:
        network: File to write.
        inputs: Inputs in their order.
        outputs: Outputs in their order.
        kind: Element type of c.
    """
    shape = len(JOINTS), 18
    write_policy(
        network, np.zeros(shape), np.zeros(len(JOINTS)), MJLAB, states=2
    )
    model = onnx.load(network)
    graph, tensor = model.graph, onnx.helper.make_tensor_value_info
    number = getattr(onnx.TensorProto, kind)
    graph.input.append(tensor("c_in", number, [1, 2]))
    graph.output.append(tensor("c_out", number, [1, 2]))
    graph.node.append(onnx.helper.make_node("Identity", ["c_in"], ["c_out"]))
    for ports, names in ((graph.input, inputs), (graph.output, outputs)):
        ordered = sorted(ports, key=lambda port: names.index(port.name))
        del ports[:]
        ports.extend(ordered)
    onnx.save(model, network)
    return network


def actions_of(network: Path) -> Any:
    """Return the actions at the third evaluation: h has counted two."""
    stepaside("robot", "legs", "inspect", network)
    loaded = PolicyNetwork(network)
    memory = loaded.initial_memory()
    for _ in range(3):
        actions, memory = loaded.evaluate(np.zeros(18), memory)
    return actions.tolist()


@pytest.mark.parametrize("inputs", ["obs h_in c_in", "h_in c_in obs"])
@pytest.mark.parametrize(
    "outputs",
    ["actions h_out c_out", "actions c_out h_out", "h_out c_out actions"],
)
def test_recurrent_states_are_told_by_name(
    inputs: str, outputs: str, tmp_path: Path
) -> None:
    network = two_states(tmp_path / "a.onnx", inputs, outputs)
    assert actions_of(network) == [2.0, 2.0, 0.0]


def test_states_that_no_name_tells_apart_are_refused(tmp_path: Path) -> None:
    network = two_states(tmp_path / "a.onnx")
    content = network.read_bytes().replace(b"h_in", b"aaaa")
    network.write_bytes(content.replace(b"c_in", b"bbbb"))
    assert "must be fed back" in refused("robot", "legs", "inspect", network)


def test_inputs_may_leave_the_number_of_walkers_open(tmp_path: Path) -> None:
    network = two_states(tmp_path / "a.onnx")
    model = onnx.load(network)
    for port in model.graph.input:
        port.type.tensor_type.shape.dim[0].dim_param = "walkers"
    onnx.save(model, network)
    assert actions_of(network) == [2.0, 2.0, 0.0]


def test_a_state_of_integers_is_refused_by_name(tmp_path: Path) -> None:
    network = two_states(tmp_path / "a.onnx", kind="INT64")
    assert "c_in" in refused("robot", "legs", "inspect", network)
