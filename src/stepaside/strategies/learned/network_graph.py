"""Feed-forward networks in ONNX files, read, written and evaluated by numpy.

Only what dense networks use is known: about 20 operators on tensors of one
batch axis. A network of another kind is refused by the name of its operator.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.atomic_output import atomic_draft
from ...core.errors import AnyPath, PolicyError, as_path
from ...core.regular_files import check_regular
from .protobuf_wire import (
    blobs,
    decode_fields,
    encode_field,
    integers,
    real,
    texts,
)

Tensor = NDArray[Any]
IR_VERSION, OPSET = 8, 17  # of the files that are written
FLOAT, INT64 = 1, 7  # codes of element types
ELEMENTS: Mapping[int, np.dtype[Any]] = {
    FLOAT: np.dtype("<f4"),
    INT64: np.dtype("<i8"),
    6: np.dtype("<i4"),
    11: np.dtype("<f8"),
}
ATTRIBUTE_INT, ATTRIBUTE_TYPE_INT = 3, 2


class NetworkNode(NamedTuple):
    """One operation of a network.

    Attributes:
        operator: Name of the operator in ONNX.
        inputs: Names of its inputs; empty for an omitted one.
        outputs: Names of its outputs.
        attributes: Numbers, lists of integers or tensors by name.
    """

    operator: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    attributes: Mapping[str, Any] = {}


@dataclass(frozen=True, eq=False)
class NetworkGraph:
    """A network: operations in order, and their constants.

    Attributes:
        nodes: Operations, each after those that give its inputs.
        constants: Weights by name.
        input: Name of the observation.
        output: Name of the action.
        width: Number of values of an observation; None if the file leaves
            it open.
        metadata: Text entries of the exporter.
    """

    nodes: tuple[NetworkNode, ...]
    constants: Mapping[str, Tensor]
    input: str
    output: str
    width: int | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the operators.

        Raises:
            PolicyError: If one is not supported.
        """
        for node in self.nodes:
            if node.operator not in OPERATORS:
                raise PolicyError(
                    f"operator {node.operator} is not supported; there are "
                    f"{', '.join(sorted(OPERATORS))}"
                )

    def evaluate(self, observations: Tensor) -> Tensor:
        """Return the outputs for a batch of observations.

        Args:
            observations: Shape (n, width).

        Returns:
            Shape (n, width of the output), in single precision.

        Raises:
            PolicyError: If the sizes do not fit.
        """
        values: dict[str, Any] = dict(self.constants)
        values[self.input] = np.asarray(observations, dtype=np.float32)
        try:
            for node in self.nodes:
                given = [values[n] if n else None for n in node.inputs]
                made = OPERATORS[node.operator](node.attributes, *given)
                values[node.outputs[0]] = made
            found: Tensor = values[self.output]
        except (KeyError, ValueError, IndexError, TypeError) as error:
            text = " ".join(str(error).split())
            raise PolicyError(f"the network does not fit: {text}") from error
        return found

    def save(self, path: AnyPath) -> None:
        """Write the network as an ONNX file."""
        with atomic_draft(as_path(path, "path")) as draft:
            draft.write_bytes(self._encoded())

    def _encoded(self) -> bytes:
        """Return the network as an ONNX model."""
        last = self.evaluate(np.zeros((1, self.width or 1))).shape[-1]
        graph = b"".join(
            [
                *(encode_field(1, _encode_node(node)) for node in self.nodes),
                encode_field(2, "strategy"),
                *(
                    encode_field(5, _encode_tensor(name, value))
                    for name, value in self.constants.items()
                ),
                encode_field(11, _encode_port(self.input, self.width)),
                encode_field(12, _encode_port(self.output, last)),
            ]
        )
        return b"".join(
            [
                encode_field(1, IR_VERSION),
                encode_field(2, "stepaside"),
                encode_field(7, graph),
                encode_field(8, encode_field(1, "") + encode_field(2, OPSET)),
                *(
                    encode_field(
                        14, encode_field(1, key) + encode_field(2, value)
                    )
                    for key, value in self.metadata.items()
                ),
            ]
        )


def read_network(path: Path) -> NetworkGraph:
    """Read an ONNX file.

    Raises:
        PolicyError: If it is not a network of supported operators.
    """
    try:
        check_regular(path)
        model = decode_fields(path.read_bytes())
    except OSError as error:
        raise PolicyError(f"cannot read {path}: {error.strerror}") from error
    except PolicyError as error:
        raise PolicyError(f"{path} is not an ONNX network: {error}") from error
    graphs = blobs(model, 7)
    if not graphs:
        raise PolicyError(f"{path} is not an ONNX network: it has no graph")
    try:
        graph = decode_fields(graphs[0])
        constants = dict(_decode_tensor(data) for data in blobs(graph, 5))
        inputs = [_decode_port(data) for data in blobs(graph, 11)]
        given = [port for port in inputs if port[0] not in constants]
        outputs = [_decode_port(data) for data in blobs(graph, 12)]
        if len(given) != 1 or len(outputs) != 1:
            raise PolicyError(
                "it must have one input and one output, got "
                f"{len(given)} and {len(outputs)}"
            )
        return NetworkGraph(
            tuple(_decode_node(data) for data in blobs(graph, 1)),
            constants,
            given[0][0],
            outputs[0][0],
            given[0][1],
            dict(_decode_entry(data) for data in blobs(model, 14)),
        )
    except (PolicyError, ValueError, IndexError) as error:
        raise PolicyError(f"network {path}: {error}") from error


def dense_network(
    layers: Sequence[tuple[Tensor, Tensor]],
    *,
    activation: str = "Relu",
    metadata: Mapping[str, str] | None = None,
) -> NetworkGraph:
    """Build a dense network.

    Args:
        layers: Weights, shape (inputs, outputs), and biases, shape
            (outputs,), of each layer.
        activation: Operator between two layers.
        metadata: Text entries.
    """
    nodes, constants, name = [], {}, "observation"
    for n, (weights, biases) in enumerate(layers):
        constants[f"weights_{n}"] = np.asarray(weights, dtype=np.float32)
        constants[f"biases_{n}"] = np.asarray(biases, dtype=np.float32)
        last = n == len(layers) - 1
        out = "action" if last else f"sum_{n}"
        inputs = (name, f"weights_{n}", f"biases_{n}")
        nodes.append(NetworkNode("Gemm", inputs, (out,)))
        if not last:
            name = f"layer_{n}"
            nodes.append(NetworkNode(activation, (out,), (name,)))
    width = int(layers[0][0].shape[0])
    return NetworkGraph(
        tuple(nodes),
        constants,
        "observation",
        "action",
        width,
        dict(metadata or {}),
    )


def _gemm(attributes: Mapping[str, Any], a: Any, b: Any, c: Any = 0.0) -> Any:
    a = a.T if attributes.get("transA") else a
    b = b.T if attributes.get("transB") else b
    product = attributes.get("alpha", 1.0) * (a @ b)
    return product + attributes.get("beta", 1.0) * c


def _clip(
    attributes: Mapping[str, Any], x: Any, low: Any = None, high: Any = None
) -> Any:
    low = attributes.get("min") if low is None else low
    high = attributes.get("max") if high is None else high
    return np.clip(x, low, high)


def _flatten(attributes: Mapping[str, Any], x: Any) -> Any:
    return x.reshape(len(x), -1)


def _softmax(attributes: Mapping[str, Any], x: Any) -> Any:
    powers = np.exp(x - x.max(axis=-1, keepdims=True))
    return powers / powers.sum(axis=-1, keepdims=True)


def _concat(attributes: Mapping[str, Any], *parts: Any) -> Any:
    return np.concatenate(parts, axis=attributes["axis"])


def _of_values(
    function: Callable[..., Any],
) -> Callable[..., Any]:
    """Return an operator without attributes."""
    return lambda attributes, *inputs: function(*inputs)


OPERATORS: Mapping[str, Callable[..., Any]] = {
    "Add": _of_values(np.add),
    "Clip": _clip,
    "Concat": _concat,
    "Constant": lambda attributes: attributes["value"],
    "Div": _of_values(np.divide),
    "Elu": lambda attributes, x: np.where(
        x > 0.0,
        x,
        attributes.get("alpha", 1.0) * np.expm1(np.minimum(x, 0.0)),
    ),
    "Flatten": _flatten,
    "Gemm": _gemm,
    "Identity": _of_values(lambda x: x),
    "MatMul": _of_values(np.matmul),
    "Mul": _of_values(np.multiply),
    "Relu": _of_values(lambda x: np.maximum(x, 0.0)),
    "Sigmoid": _of_values(lambda x: 1.0 / (1.0 + np.exp(-x))),
    "Softmax": _softmax,
    "Sub": _of_values(np.subtract),
    "Tanh": _of_values(np.tanh),
}
"""Evaluation of each supported operator."""


def _encode_node(node: NetworkNode) -> bytes:
    parts = [encode_field(1, name) for name in node.inputs]
    parts += [encode_field(2, name) for name in node.outputs]
    parts.append(encode_field(4, node.operator))
    for key, value in node.attributes.items():
        named = encode_field(1, key)
        number = encode_field(ATTRIBUTE_INT, int(value))
        kind = encode_field(20, ATTRIBUTE_TYPE_INT)
        parts.append(encode_field(5, named + number + kind))
    return b"".join(parts)


def _encode_tensor(name: str, value: Tensor) -> bytes:
    data = np.ascontiguousarray(value, dtype=ELEMENTS[FLOAT])
    sizes = b"".join(encode_field(1, size) for size in data.shape)
    kind = encode_field(2, FLOAT)
    return (
        sizes + kind + encode_field(8, name) + encode_field(9, data.tobytes())
    )


def _encode_port(name: str, width: int | None) -> bytes:
    batch = encode_field(1, encode_field(2, "batch"))
    size = b"" if width is None else encode_field(1, width)
    shape = encode_field(2, batch + encode_field(1, size))
    tensor = encode_field(1, encode_field(1, FLOAT) + shape)
    return encode_field(1, name) + encode_field(2, tensor)


def _decode_node(data: bytes) -> NetworkNode:
    fields = decode_fields(data)
    return NetworkNode(
        texts(fields, 4)[0],
        tuple(texts(fields, 1)),
        tuple(texts(fields, 2)),
        dict(_decode_attribute(each) for each in blobs(fields, 5)),
    )


def _decode_attribute(data: bytes) -> tuple[str, Any]:
    fields = decode_fields(data)
    name, tensors = texts(fields, 1)[0], blobs(fields, 5)
    if tensors:
        return name, _decode_tensor(tensors[0])[1]
    if 8 in fields:
        return name, integers(fields, 8)
    if 3 in fields:
        value = integers(fields, 3)[0]
        return name, value - (1 << 64) if value >> 63 else value
    return name, real(fields, 2, 0.0)


def _decode_tensor(data: bytes) -> tuple[str, Tensor]:
    fields = decode_fields(data)
    name, shape = (texts(fields, 8) or [""])[0], integers(fields, 1)
    values: Tensor
    code = (integers(fields, 2) or [0])[0]
    if code not in ELEMENTS:
        raise PolicyError(f"element type {code} of {name} is not supported")
    if 1 in integers(fields, 14):
        raise PolicyError(
            f"{name} must be in the file of the network, not in one beside it"
        )
    raw = blobs(fields, 9)
    if raw:
        values = np.frombuffer(raw[0], dtype=ELEMENTS[code])
    elif code == FLOAT:
        values = np.frombuffer(b"".join(blobs(fields, 4)), ELEMENTS[FLOAT])
    else:
        values = np.array(integers(fields, 7), dtype=ELEMENTS[code])
    return name, values.reshape(shape)


def _decode_port(data: bytes) -> tuple[str, int | None]:
    """Return name and last size of an input or output."""
    fields = decode_fields(data)
    try:
        kind = decode_fields(blobs(fields, 2)[0])
        tensor = decode_fields(blobs(kind, 1)[0])
        shape = decode_fields(blobs(tensor, 2)[0])
        last = decode_fields(blobs(shape, 1)[-1])
        width = integers(last, 1)
    except IndexError:  # a shape is optional
        width = []
    return texts(fields, 1)[0], width[0] if width else None


def _decode_entry(data: bytes) -> tuple[str, str]:
    fields = decode_fields(data)
    return texts(fields, 1)[0], (texts(fields, 2) or [""])[0]
