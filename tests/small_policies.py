"""Small walking policies, made for tests."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

JOINTS = ("hip", "knee", "ankle")
METADATA = {
    "dof_names": list(JOINTS),
    "kp": [40.0, 50.0, 20.0],
    "kd": [2.0, 3.0, 1.0],
    "command_ranges": {"lin_vel_x": [-0.8, 1.0], "ang_vel_yaw": [-0.5, 0.5]},
}
"""Metadata as holosoma writes them, for three joints."""
WIDTH = 3 * len(JOINTS) + 3 + 3 + 3 + 4
"""Width of a holosoma observation for three joints."""


def write_policy(
    path: Path,
    weights: np.ndarray,
    bias: np.ndarray,
    metadata: Mapping[str, Any] | None = None,
    *,
    states: int = 0,
    one: bool = False,
) -> Path:
    """Write a policy whose action is linear in its observation.

    Args:
        path: File to write.
        weights: Shape (actions, width of the observation).
        bias: Shape (actions,).
        metadata: Text entries; other values are written as JSON.
        states: Width of a recurrent state that counts evaluations and is
            added to the first actions; 0 for none.
        one: Whether the graph serves one walker at a time.
    """
    count, width = weights.shape
    tensor, real = helper.make_tensor_value_info, TensorProto.FLOAT
    inputs = [tensor("obs", real, [1, width])]
    outputs = [tensor("actions", real, [1, count])]
    numbers = {"weights": weights.T, "bias": bias}
    product = "actions" if not states else "stateless"
    given = "row" if one else "obs"
    nodes = [helper.make_node("Gemm", [given, "weights", "bias"], [product])]
    if one:
        nodes.insert(0, helper.make_node("Reshape", ["obs", "size"], ["row"]))
    if states:
        inputs.append(tensor("h_in", real, [1, states]))
        outputs.append(tensor("h_out", real, [1, states]))
        numbers["one"] = np.ones((1, states))
        numbers["spread"] = np.eye(states, count)
        nodes += [
            helper.make_node("Add", ["h_in", "one"], ["h_out"]),
            helper.make_node("MatMul", ["h_in", "spread"], ["memory"]),
            helper.make_node("Add", ["stateless", "memory"], ["actions"]),
        ]
    initializers = [
        numpy_helper.from_array(value.astype(np.float32), name)
        for name, value in numbers.items()
    ]
    if one:
        initializers.append(
            numpy_helper.from_array(np.array([1, width]), "size")
        )
    graph = helper.make_graph(nodes, "policy", inputs, outputs, initializers)
    opset = [helper.make_opsetid("", 17)]
    model = helper.make_model(graph, opset_imports=opset, ir_version=9)
    helper.set_model_props(
        model,
        {
            key: value if isinstance(value, str) else json.dumps(value)
            for key, value in (metadata or {}).items()
        },
    )
    onnx.save(model, path)
    return path


def constant_policy(path: Path, action: float = 0.0, **changes: Any) -> Path:
    """Write a holosoma policy of three joints with a constant action."""
    metadata = METADATA | changes
    shape = len(JOINTS), WIDTH
    bias = np.full(len(JOINTS), action)
    return write_policy(path, np.zeros(shape), bias, metadata)
