"""Test networks in ONNX files."""

from pathlib import Path

import numpy as np
import pytest

from stepaside.core.errors import PolicyError
from stepaside.strategies.learned.network_graph import (
    NetworkGraph,
    NetworkNode,
    dense_network,
    read_network,
)

RANDOM = np.random.default_rng(5)
LAYERS = [
    (RANDOM.normal(size=(6, 8)), RANDOM.normal(size=8)),
    (RANDOM.normal(size=(8, 3)), RANDOM.normal(size=3)),
]
INPUTS = RANDOM.normal(size=(4, 6)).astype(np.float32)


@pytest.fixture(params=["Relu", "Tanh", "Elu", "Sigmoid"])
def network(request: pytest.FixtureRequest) -> NetworkGraph:
    return dense_network(
        LAYERS, activation=request.param, metadata={"of": "a test", "no": ""}
    )


def test_a_dense_network_is_products_and_activations() -> None:
    (first, b), (second, c) = LAYERS
    expected = np.maximum(INPUTS @ first + b, 0.0) @ second + c
    found = dense_network(LAYERS).evaluate(INPUTS)
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-5)


def test_a_file_holds_the_network(
    network: NetworkGraph, tmp_path: Path
) -> None:
    network.save(tmp_path / "a.onnx")
    again = read_network(tmp_path / "a.onnx")
    assert again.metadata == {"of": "a test", "no": ""}
    assert again.width == 6
    np.testing.assert_array_equal(
        again.evaluate(INPUTS), network.evaluate(INPUTS)
    )


def test_onnx_runtime_computes_the_same(
    network: NetworkGraph, tmp_path: Path
) -> None:
    runtime = pytest.importorskip("onnxruntime")
    onnx = pytest.importorskip("onnx")
    file = str(tmp_path / "a.onnx")
    network.save(file)
    onnx.checker.check_model(file, full_check=True)
    session = runtime.InferenceSession(file)
    found = session.run(None, {"observation": INPUTS})[0]
    np.testing.assert_allclose(
        found, network.evaluate(INPUTS), rtol=1e-5, atol=1e-5
    )


def test_files_of_another_exporter_are_read(tmp_path: Path) -> None:
    """Transposed weights, constants as nodes, doubles and limits."""
    onnx = pytest.importorskip("onnx")
    helper, arrays = onnx.helper, onnx.numpy_helper
    weights = LAYERS[0][0].T.astype(np.float32)
    nodes = [
        helper.make_node("Gemm", ["x", "w", "b"], ["s"], transB=1, alpha=0.5),
        helper.make_node(
            "Constant",
            [],
            ["low"],
            value=arrays.from_array(np.float32(-1.0)),
        ),
        helper.make_node("Clip", ["s", "low", "high"], ["c"]),
        helper.make_node("Softmax", ["c"], ["y"], axis=-1),
    ]
    port = helper.make_tensor_value_info
    graph = helper.make_graph(
        nodes,
        "other",
        [port("x", onnx.TensorProto.FLOAT, [None, 6])],
        [port("y", onnx.TensorProto.FLOAT, [None, 8])],
        [
            arrays.from_array(weights, "w"),
            helper.make_tensor(
                "b", onnx.TensorProto.FLOAT, [8], LAYERS[0][1].tolist()
            ),
            arrays.from_array(np.float32(2.0), "high"),
        ],
    )
    file = tmp_path / "other.onnx"
    onnx.save(helper.make_model(graph), file)
    found = read_network(file).evaluate(INPUTS)
    sums = 0.5 * INPUTS @ LAYERS[0][0] + LAYERS[0][1]
    powers = np.exp(np.clip(sums, -1.0, 2.0))
    expected = powers / powers.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_an_operator_that_is_not_supported_is_named() -> None:
    node = NetworkNode("LSTM", ("x",), ("y",))
    with pytest.raises(PolicyError, match="operator LSTM is not supported"):
        NetworkGraph((node,), {}, "x", "y")


def test_a_file_that_ends_early_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.onnx"
    dense_network(LAYERS, metadata={"of": "a test"}).save(file)
    whole = file.read_bytes()
    network_ends = whole.index(b"of") - 6  # what follows is metadata
    for size in range(0, network_ends, 7):
        file.write_bytes(whole[:size])
        with pytest.raises(PolicyError):
            read_network(file)


@pytest.mark.parametrize("content", [b"", b"hello world", b"\xff" * 40])
def test_other_files_are_refused(content: bytes, tmp_path: Path) -> None:
    file = tmp_path / "a.onnx"
    file.write_bytes(content)
    with pytest.raises(PolicyError, match="is not an ONNX network"):
        read_network(file)


def test_an_observation_of_another_size_is_refused() -> None:
    with pytest.raises(PolicyError, match="does not fit"):
        dense_network(LAYERS).evaluate(np.zeros((1, 5)))
