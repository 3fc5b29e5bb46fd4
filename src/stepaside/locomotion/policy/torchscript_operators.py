"""Operations of TorchScript as operations of ONNX."""

from collections.abc import Callable, Sequence
from math import prod, sqrt
from typing import Any

import numpy as np

from ...core.errors import PolicyError
from ...core.poses import Array
from .tensor_graph import GraphTensor, TensorGraph, WidthFound, broadcast

Operator = Callable[..., Any]
LAST = 2**62  # an end of a slice beyond this is the end of the axis
GATES = {  # order of the gates in ONNX, by their order in PyTorch
    "LSTM": (0, 3, 1, 2),
    "GRU": (1, 0, 2),
}


class UnknownWidth:
    """Width of the input, while it is not known.

    A comparison with a number determines it.
    """

    def __eq__(self, other: object) -> bool:
        """Take the other side for the width."""
        if isinstance(other, int):
            raise WidthFound(other)
        return NotImplemented

    __hash__ = None  # type: ignore[assignment]


def _tensor(graph: TensorGraph, value: Any) -> GraphTensor:
    """Return a tensor; a number becomes a constant."""
    if isinstance(value, GraphTensor):
        return value
    return graph.constant(value)


def _unary(operation: str, **names: float) -> Operator:
    """Return an operation on each element.

    Args:
        operation: Name in ONNX.
        names: Attributes in the order of the arguments, with their defaults.
    """

    def apply(graph: TensorGraph, x: GraphTensor, *given: Any) -> GraphTensor:
        values = (*given, *list(names.values())[len(given) :])
        chosen = zip(names, values, strict=False)
        attributes = {name: float(value) for name, value in chosen}
        return graph.add(operation, [x], x.shape, **attributes)

    return apply


def _binary(operation: str) -> Operator:
    """Return an operation on elements of two tensors, or of numbers."""

    def apply(
        graph: TensorGraph, x: Any, y: Any, alpha: float = 1
    ) -> GraphTensor | float:
        if not isinstance(x, GraphTensor) and not isinstance(y, GraphTensor):
            value: float = NUMBERS[operation](x, y)
            return value
        first, second = _tensor(graph, x), _tensor(graph, y)
        if alpha != 1:
            second = apply_scale(graph, second, alpha)
        shape = broadcast(first.shape, second.shape)
        return graph.add(operation, [first, second], shape)

    return apply


NUMBERS: dict[str, Callable[[Any, Any], Any]] = {
    "Add": lambda x, y: x + y,
    "Sub": lambda x, y: x - y,
    "Mul": lambda x, y: x * y,
    "Div": lambda x, y: x / y,
    "Pow": lambda x, y: x**y,
}


def apply_scale(
    graph: TensorGraph, x: GraphTensor, factor: float
) -> GraphTensor:
    """Return a tensor times a number."""
    return graph.add("Mul", [x, graph.constant(factor)], x.shape)


def _linear(
    graph: TensorGraph,
    x: GraphTensor,
    weight: GraphTensor,
    bias: GraphTensor | None = None,
) -> GraphTensor:
    """Dense layer; the rows of the weight are outputs."""
    outputs, inputs = (int(size or 0) for size in weight.shape)
    _check_width(x, inputs)
    shape = (*x.shape[:-1], outputs)
    if len(x.shape) == 2:
        return graph.add("Gemm", [x, weight, bias], shape, transB=1)
    turned = graph.add("Transpose", [weight], (inputs, outputs), perm=[1, 0])
    result = graph.add("MatMul", [x, turned], shape)
    return result if bias is None else graph.add("Add", [result, bias], shape)


def _matmul(
    graph: TensorGraph, x: GraphTensor, weight: GraphTensor
) -> GraphTensor:
    """Matrix product."""
    inputs, outputs = weight.shape
    _check_width(x, inputs or 0)
    return graph.add("MatMul", [x, weight], (*x.shape[:-1], outputs))


def _addmm(
    graph: TensorGraph,
    bias: GraphTensor,
    x: GraphTensor,
    weight: GraphTensor,
    beta: float = 1,
    alpha: float = 1,
) -> GraphTensor:
    """Dense layer as matrix product and sum."""
    inputs, outputs = weight.shape
    _check_width(x, inputs or 0)
    factors = {"alpha": float(alpha), "beta": float(beta)}
    return graph.add(
        "Gemm", [x, weight, bias], (x.shape[0], outputs), **factors
    )


def _check_width(x: GraphTensor, width: int) -> None:
    """Check the last axis of the input of a layer.

    Raises:
        WidthFound: If it was not known.
        PolicyError: If it differs.
    """
    if x.shape[-1] is None:
        raise WidthFound(width)
    if x.shape[-1] != width:
        raise PolicyError(
            f"a layer of {width} inputs is given {x.shape[-1]} values"
        )


def _recurrent(kind: str) -> Operator:
    """Return an LSTM or GRU of one or several layers."""

    def apply(
        graph: TensorGraph,
        x: GraphTensor,
        states: Any,
        weights: Sequence[GraphTensor],
        *options: Any,
    ) -> tuple[GraphTensor, ...]:
        has_biases, layers, _, _, bidirectional, batch_first = options
        if bidirectional:
            raise PolicyError(f"{kind} must not be bidirectional")
        if batch_first:
            x = _permuted(graph, x, (1, 0, 2))
        given = list(states) if kind == "LSTM" else [states]
        each = 4 if has_biases else 2
        ends: list[list[GraphTensor]] = [[] for _ in given]
        for i in range(layers):
            own = weights[i * each : (i + 1) * each]
            begins = [_sliced(graph, s, 0, i, i + 1) for s in given]
            x, *last = _layer(graph, kind, x, begins, own)
            for end, value in zip(ends, last, strict=True):
                end.append(value)
        if batch_first:
            x = _permuted(graph, x, (1, 0, 2))
        return (x, *(_joined(graph, end, 0) for end in ends))

    return apply


def _layer(
    graph: TensorGraph,
    kind: str,
    x: GraphTensor,
    states: Sequence[GraphTensor],
    weights: Sequence[GraphTensor],
) -> tuple[GraphTensor, ...]:
    """Return the sequence of outputs of one layer, and its last states."""
    given = [graph.values(weight) for weight in weights]
    _check_width(x, given[0].shape[1])
    ordered = [_gates(kind, value) for value in given]
    bias = None
    if len(ordered) == 4:
        bias = graph.constant(np.concatenate(ordered[2:])[None])
    hidden = given[1].shape[1]
    length, batch, _ = x.shape
    inputs = [x, *(graph.constant(w[None]) for w in ordered[:2]), bias, None]
    attributes = {"hidden_size": hidden}
    if kind == "GRU":
        attributes["linear_before_reset"] = 1
    shape = (length, 1, batch, hidden)
    output = graph.add(kind, [*inputs, *states], shape, **attributes)
    node = graph.nodes.pop()
    names = tuple(f"{output.name}_{i}" for i in range(len(states)))
    graph.nodes.append(node._replace(outputs=(output.name, *names)))
    last = (GraphTensor(name, (1, batch, hidden)) for name in names)
    return graph.reshape(output, (length, batch, hidden)), *last


def _gates(kind: str, weight: Array) -> Array:
    """Return a weight or bias with its gates in the order of ONNX."""
    order = GATES[kind]
    parts = np.split(weight, len(order))
    ordered: Array = np.concatenate([parts[i] for i in order])
    return ordered


def _axis(x: GraphTensor, axis: int) -> int:
    return axis + len(x.shape) if axis < 0 else axis


def _sliced(
    graph: TensorGraph,
    x: GraphTensor,
    axis: int = 0,
    start: int | None = None,
    end: int | None = None,
    step: int = 1,
) -> GraphTensor:
    """Part of an axis; the tensor itself if that is all of it."""
    axis, first = _axis(x, axis), start or 0
    size = x.shape[axis]
    to_end = end is None or end >= (LAST if size is None else size)
    if first == 0 and to_end and step == 1:
        return x
    if size is None:
        raise PolicyError(
            "the code takes a part of the input: its width must be given"
        )
    last = size if to_end or end is None else end
    count = len(range(size)[first:last:step])
    bounds = [[first], [last], [axis], [step]]
    shape = (*x.shape[:axis], count, *x.shape[axis + 1 :])
    constants = (graph.constant(bound, "i8") for bound in bounds)
    result = graph.add("Slice", [x, *constants], shape)
    result.is_part = True
    return result


def _selected(
    graph: TensorGraph, x: GraphTensor, axis: int, index: int
) -> GraphTensor:
    """Element of an axis, which disappears."""
    axis = _axis(x, axis)
    end = None if index == -1 else index + 1
    part = _sliced(graph, x, axis, index, end)
    return graph.reshape(part, (*x.shape[:axis], *x.shape[axis + 1 :]))


def _squeezed(
    graph: TensorGraph, x: GraphTensor, axis: int | None = None
) -> GraphTensor:
    """Tensor without one axis of size 1, or without all of them."""
    gone = None if axis is None else _axis(x, axis)
    shape = [
        size
        for i, size in enumerate(x.shape)
        if size != 1 or (gone is not None and i != gone)
    ]
    return graph.reshape(x, shape)


def _unsqueezed(graph: TensorGraph, x: GraphTensor, axis: int) -> GraphTensor:
    """Tensor with another axis of size 1."""
    axis = axis + len(x.shape) + 1 if axis < 0 else axis
    return graph.reshape(x, (*x.shape[:axis], 1, *x.shape[axis:]))


def _reshaped(
    graph: TensorGraph, x: GraphTensor, sizes: Sequence[Any]
) -> GraphTensor:
    """Tensor in another shape; -1 stands for the rest."""
    shape = [None if isinstance(s, UnknownWidth) else int(s) for s in sizes]
    if -1 in shape:
        given = [size for size in x.shape if size is not None]
        other = [s for s in shape if s is not None and s != -1]
        rest = prod(given) // max(1, prod(other))
        shape[shape.index(-1)] = rest if None not in x.shape else None
    return graph.reshape(x, shape)


def _flattened(
    graph: TensorGraph, x: GraphTensor, start: int = 0, end: int = -1
) -> GraphTensor:
    """Tensor with several axes joined to one."""
    first, last = _axis(x, start), _axis(x, end)
    sizes: list[Any] = [*x.shape[:first], -1, *x.shape[last + 1 :]]
    return _reshaped(graph, x, sizes)


def _permuted(
    graph: TensorGraph, x: GraphTensor, axes: Sequence[int]
) -> GraphTensor:
    """Tensor with its axes in another order."""
    order = [_axis(x, axis) for axis in axes]
    shape = [x.shape[axis] for axis in order]
    return graph.add("Transpose", [x], shape, perm=order)


def _transposed(
    graph: TensorGraph, x: GraphTensor, first: int = 0, second: int = 1
) -> GraphTensor:
    """Tensor with two axes exchanged."""
    axes = list(range(len(x.shape)))
    axes[first], axes[second] = axes[second], axes[first]
    return _permuted(graph, x, axes)


def _joined(
    graph: TensorGraph, parts: Sequence[GraphTensor], axis: int = 0
) -> GraphTensor:
    """Tensors joined along an axis."""
    if len(parts) == 1:
        return parts[0]
    axis = _axis(parts[0], axis)
    sizes = [part.shape[axis] for part in parts]
    total = None if None in sizes else sum(s for s in sizes if s is not None)
    shape = (*parts[0].shape[:axis], total, *parts[0].shape[axis + 1 :])
    return graph.add("Concat", parts, shape, axis=axis)


def _clipped(
    graph: TensorGraph,
    x: GraphTensor,
    low: float | None = None,
    high: float | None = None,
) -> GraphTensor:
    """Tensor limited to a range."""
    limits = (None if v is None else graph.constant(v) for v in (low, high))
    return graph.add("Clip", [x, *limits], x.shape)


def _silu(graph: TensorGraph, x: GraphTensor) -> GraphTensor:
    """Sigmoid linear unit."""
    share = graph.add("Sigmoid", [x], x.shape)
    return graph.add("Mul", [x, share], x.shape)


def _gelu(
    graph: TensorGraph, x: GraphTensor, approximate: str = "none"
) -> GraphTensor:
    """Gaussian error linear unit."""
    if approximate != "none":
        raise PolicyError("gelu must not be approximate")
    shape = x.shape
    scaled = apply_scale(graph, x, 1.0 / sqrt(2.0))
    share = graph.add("Erf", [scaled], shape)
    share = graph.add("Add", [share, graph.constant(1.0)], shape)
    return apply_scale(graph, graph.add("Mul", [x, share], shape), 0.5)


def _layer_norm(
    graph: TensorGraph,
    x: GraphTensor,
    normalised: Sequence[int],
    weight: GraphTensor | None = None,
    bias: GraphTensor | None = None,
    eps: float = 1e-5,
    *_: Any,
) -> GraphTensor:
    """Normalisation over the last axes."""
    _check_width(x, normalised[-1])
    scale = weight or graph.constant(np.ones(normalised))
    return graph.add(
        "LayerNormalization",
        [x, scale, bias],
        x.shape,
        axis=-len(normalised),
        epsilon=eps,
    )


def _batch_norm(
    graph: TensorGraph,
    x: GraphTensor,
    weight: GraphTensor,
    bias: GraphTensor,
    mean: GraphTensor,
    variance: GraphTensor,
    *options: Any,
) -> GraphTensor:
    """Normalisation with constants."""
    _, _, eps, *_ = options  # after training and momentum
    _check_width(x, mean.shape[0] or 0)
    inputs = [x, weight, bias, mean, variance]
    return graph.add("BatchNormalization", inputs, x.shape, epsilon=eps)


def _size(_: TensorGraph, x: GraphTensor, axis: int | None = None) -> Any:
    """Return the size of an axis, or of all axes."""
    sizes = [UnknownWidth() if s is None else s for s in x.shape]
    return sizes if axis is None else sizes[axis]


def _filled(value: float) -> Operator:
    """Return a tensor of one value, in a given shape."""

    def create(
        graph: TensorGraph, shape: Sequence[int], *_: Any, **__: Any
    ) -> GraphTensor:
        return graph.constant(np.full(shape, value))

    return create


def _same(_: TensorGraph, x: Any, *__: Any, **___: Any) -> Any:
    """Return the tensor unchanged: the operation acts only in training."""
    return x


def _renamed(
    graph: TensorGraph, x: GraphTensor, *_: Any, **__: Any
) -> GraphTensor:
    """Return a copy, which operations in place do not share."""
    return graph.add("Identity", [x], x.shape)


def _set(
    graph: TensorGraph, x: GraphTensor, value: Any, *_: Any
) -> GraphTensor:
    """Copy values into a tensor."""
    given = _tensor(graph, value)
    if given.shape != x.shape and None not in x.shape:
        filled = graph.constant(np.zeros([s or 0 for s in x.shape]))
        shape = broadcast(filled.shape, given.shape)
        given = graph.add("Add", [filled, given], shape)
    return graph.update(x, given)


OPERATORS: dict[str, Operator] = {
    **{
        name: _unary(name.capitalize())
        for name in (
            *("relu", "tanh", "sigmoid", "neg", "exp", "log", "sqrt", "abs"),
            *("sin", "cos", "softsign"),
        )
    },
    "elu": _unary("Elu", alpha=1.0),
    "celu": _unary("Celu", alpha=1.0),
    "leaky_relu": _unary("LeakyRelu", alpha=0.01),
    "selu": _unary("Selu"),
    "softplus": lambda graph, x, *_: graph.add("Softplus", [x], x.shape),
    "silu": _silu,
    "gelu": _gelu,
    "add": _binary("Add"),
    "sub": _binary("Sub"),
    "mul": _binary("Mul"),
    "div": _binary("Div"),
    "pow": _binary("Pow"),
    "maximum": _binary("Max"),
    "minimum": _binary("Min"),
    "linear": _linear,
    "matmul": _matmul,
    "mm": _matmul,
    "addmm": _addmm,
    "lstm": _recurrent("LSTM"),
    "gru": _recurrent("GRU"),
    "slice": _sliced,
    "select": _selected,
    "squeeze": _squeezed,
    "unsqueeze": _unsqueezed,
    "reshape": _reshaped,
    "view": _reshaped,
    "flatten": _flattened,
    "permute": _permuted,
    "transpose": _transposed,
    "t": _transposed,
    "numpy_T": _transposed,
    "cat": _joined,
    "clamp": _clipped,
    "clip": _clipped,
    "hardtanh": _clipped,
    "layer_norm": _layer_norm,
    "batch_norm": _batch_norm,
    "size": _size,
    "dim": lambda _, x: len(x.shape),
    "len": lambda _, x: len(x),
    "zeros": _filled(0.0),
    "ones": _filled(1.0),
    "zeros_like": lambda graph, x, **_: graph.constant(np.zeros(x.shape)),
    "tensor": lambda graph, value, **_: graph.constant(value),
    "copy_": _set,
    "dropout": _same,
    "contiguous": _same,
    "detach": _same,
    "to": _same,
    "type_as": _same,
    "clone": _renamed,
}
"""Operations on tensors, by their names in TorchScript."""

PLAIN: dict[str, Callable[..., Any]] = {
    "eq": lambda x, y: x == y,
    "ne": lambda x, y: not x == y,
    "lt": lambda x, y: x < y,
    "le": lambda x, y: x <= y,
    "gt": lambda x, y: x > y,
    "ge": lambda x, y: x >= y,
    "__not__": lambda x: not x,
    "__and__": lambda x, y: x and y,
    "__or__": lambda x, y: x or y,
    "__is__": lambda x, y: x is y,
    "__isnot__": lambda x, y: x is not y,
    "__contains__": lambda values, x: x in values,
    "__getitem__": lambda values, index: values[index],
    "format": lambda text, *values: str(text).format(*values),
    "list": list,
    "append": lambda values, x: values.append(x),
    "warn": lambda *_: None,
}
"""Operations on plain values, by their names in TorchScript."""

DECIDING = frozenset({"eq", "ne", "lt", "le", "gt", "ge", "__not__"})
"""Operators whose result depends on the values of tensors."""
