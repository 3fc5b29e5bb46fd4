"""Conversion of a TorchScript archive to an ONNX network."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import PolicyError
from .network import TensorShape
from .tensor_graph import GraphTensor, TensorGraph, WidthFound
from .torchscript_archive import TorchScriptArchive, read_archive
from .torchscript_interpreter import ScriptInterpreter

OPSET = 17, 9  # version of the operations and of the format


class ConvertedNetwork(NamedTuple):
    """Network as a graph with one observation and one action.

    Attributes:
        graph: Its operations.
        observation: Its input, of shape (1, width).
        action: Its output.
    """

    graph: TensorGraph
    observation: GraphTensor
    action: GraphTensor

    @property
    def width(self) -> int:
        """Width of the observation."""
        return self.observation.shape[1] or 0

    @property
    def inputs(self) -> list[TensorShape]:
        """Inputs of the ONNX network: the observation, and the states."""
        return [TensorShape("obs", self.observation.shape), *self._states]

    @property
    def outputs(self) -> list[TensorShape]:
        """Outputs of the ONNX network: the action, and the new states."""
        states = [(f"{name}_out", shape) for name, shape in self._states]
        return [
            TensorShape("actions", self.action.shape),
            *(TensorShape(*state) for state in states),
        ]

    @property
    def _states(self) -> list[TensorShape]:
        arrays = self.graph.arrays
        return [TensorShape(n, arrays[n].shape) for n in self.graph.states]


def convert_torchscript(
    path: Path, width: int | None = None
) -> ConvertedNetwork:
    """Convert the network of a TorchScript archive.

    Args:
        path: Archive, as ``torch.jit.save`` writes it.
        width: Width of the observation; by default it follows from the first
            layer.

    Raises:
        PolicyError: If the file is no such archive, or its code has no
            counterpart in ONNX.
    """
    archive = read_archive(path)
    try:
        return _convert(archive, width)
    except WidthFound as found:
        try:
            return _convert(archive, found.width)
        except PolicyError as error:
            raise PolicyError(f"legs: {path}: {error}") from error
    except PolicyError as error:
        raise PolicyError(f"legs: {path}: {error}") from error


def _convert(
    archive: TorchScriptArchive, width: int | None
) -> ConvertedNetwork:
    """Follow the code with an observation of a width."""
    interpreter = ScriptInterpreter(archive)
    observation = GraphTensor("obs", (1, width))
    result = interpreter.forward(observation)
    if isinstance(result, tuple) and result:
        result = result[0]
    if not isinstance(result, GraphTensor):
        raise PolicyError("forward must return one action")
    if len(result.shape) != 2 or result.shape[0] != 1 or width is None:
        raise PolicyError(
            f"forward must return an action of shape [1, joints] for an "
            f"observation of shape [1, width], got {list(result.shape)}"
        )
    return ConvertedNetwork(
        interpreter.graph, GraphTensor("obs", (1, width)), result
    )


def write_network(
    network: ConvertedNetwork, file: Path, metadata: Mapping[str, str]
) -> None:
    """Write a network as ONNX; its states are further inputs and outputs.

    Args:
        network: Network.
        file: File to write.
        metadata: Text entries of the file.
    """
    import onnx
    from onnx import TensorProto, helper, numpy_helper

    graph, states = network.graph, network.graph.states

    def described(shapes: list[TensorShape]) -> list[Any]:
        kind = TensorProto.FLOAT
        return [helper.make_tensor_value_info(n, kind, s) for n, s in shapes]

    nodes = [helper.make_node(*node[:3], **node[3]) for node in graph.nodes]
    inputs, outputs = described(network.inputs), described(network.outputs)
    for name, last in states.items():
        nodes.append(helper.make_node("Identity", [last], [f"{name}_out"]))
    last = network.action.name
    nodes.append(helper.make_node("Identity", [last], ["actions"]))
    used = {name for node in nodes for name in node.input}
    arrays = [
        numpy_helper.from_array(np.ascontiguousarray(values), name)
        for name, values in graph.arrays.items()
        if name in used and name not in states
    ]
    model = helper.make_model(
        helper.make_graph(nodes, "policy", inputs, outputs, arrays),
        opset_imports=[helper.make_opsetid("", OPSET[0])],
        ir_version=OPSET[1],
    )
    helper.set_model_props(model, dict(metadata))
    onnx.checker.check_model(model)
    onnx.save(model, file)
