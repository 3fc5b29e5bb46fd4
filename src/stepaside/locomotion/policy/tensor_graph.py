"""Graph of a network: tensors and the operations between them."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import PolicyError
from ...core.poses import Array


class GraphNode(NamedTuple):
    """Operation of ONNX with the names of its tensors.

    Attributes:
        operation: Name in ONNX.
        inputs: Names of its inputs; empty for one that is left out.
        outputs: Names of its outputs.
        attributes: Its attributes.
    """

    operation: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    attributes: dict[str, Any]


@dataclass(eq=False)
class GraphTensor:
    """Value in a graph; an operation in place changes its name.

    Attributes:
        name: Name of its value at this point.
        shape: Its shape; None for the width of an input that is not known
            yet.
        stored: Name of the stored tensor that it is; empty for results.
        is_part: Whether it shares values with a larger tensor.
    """

    name: str
    shape: tuple[int | None, ...]
    stored: str = ""
    is_part: bool = False


class WidthFound(Exception):
    """The width of the input follows from an operation.

    Attributes:
        width: The width.
    """

    def __init__(self, width: int) -> None:
        """Keep the width."""
        super().__init__(width)
        self.width = width


class TensorGraph:
    """Graph that grows by one node with each operation.

    Attributes:
        nodes: Operations in order.
        arrays: Constants and stored tensors, by name.
        states: Name of the last value of each stored tensor that changes, by
            the name of the tensor: the recurrent states.
    """

    def __init__(self) -> None:
        """Begin empty."""
        self.nodes: list[GraphNode] = []
        self.arrays: dict[str, Array] = {}
        self.states: dict[str, str] = {}

    def constant(self, values: Any, kind: str = "f4") -> GraphTensor:
        """Add a constant, in single precision by default."""
        array: Array = np.asarray(values, kind)
        name = f"constant_{len(self.arrays)}"
        self.arrays[name] = array
        return GraphTensor(name, array.shape)

    def store(self, name: str, values: Array) -> GraphTensor:
        """Add a stored tensor: a weight, or a state."""
        self.arrays[name] = np.asarray(values, "f4")
        return GraphTensor(name, values.shape, stored=name)

    def values(self, tensor: GraphTensor) -> Array:
        """Return the values of a constant or an unchanged stored tensor.

        Raises:
            PolicyError: If the tensor is the result of an operation.
        """
        if tensor.name not in self.arrays:
            raise PolicyError("weights must be constants of the network")
        return self.arrays[tensor.name]

    def add(
        self,
        operation: str,
        inputs: Sequence[GraphTensor | None],
        shape: Sequence[int | None],
        **attributes: Any,
    ) -> GraphTensor:
        """Add an operation with one output of a shape."""
        name = f"value_{len(self.nodes)}"
        names = tuple("" if x is None else x.name for x in inputs)
        self.nodes.append(GraphNode(operation, names, (name,), attributes))
        return GraphTensor(name, tuple(shape))

    def reshape(
        self, x: GraphTensor, shape: Sequence[int | None]
    ) -> GraphTensor:
        """Return the values of a tensor in another shape."""
        if None not in (*shape, *x.shape):
            if prod(map(int, shape)) != prod(map(int, x.shape)):  # type: ignore[arg-type]
                raise PolicyError(
                    f"values of shape {list(x.shape)} must fit the shape "
                    f"{list(shape)}"
                )
        sizes = [-1 if size is None else size for size in shape]
        result = self.add("Reshape", [x, self.constant(sizes, "i8")], shape)
        result.is_part = True
        return result

    def update(self, tensor: GraphTensor, value: GraphTensor) -> GraphTensor:
        """Set a tensor in place; one that is stored becomes a state.

        Raises:
            PolicyError: If the tensor is a part of another, or of another
                shape.
        """
        if tensor.is_part:
            raise PolicyError(
                "a part of a tensor is changed in place; only whole tensors "
                "can be"
            )
        if tensor.shape != value.shape:
            raise PolicyError(
                f"a tensor of shape {list(tensor.shape)} is set to one of "
                f"shape {list(value.shape)}"
            )
        if tensor.stored:
            self.states[tensor.stored] = value.name
        tensor.name = value.name
        return tensor


def broadcast(
    *shapes: tuple[int | None, ...],
) -> tuple[int | None, ...]:
    """Return the shape of an operation element by element.

    Raises:
        WidthFound: If the shapes show the width of the input.
        PolicyError: If the shapes do not fit.
    """
    rank = max(map(len, shapes))
    result: list[int | None] = []
    for axis in range(-rank, 0):
        sizes = {s[axis] for s in shapes if len(s) >= -axis} - {1}
        known = [size for size in sizes if size is not None]
        if len(known) > 1:
            texts = " and ".join(str(list(shape)) for shape in shapes)
            raise PolicyError(f"shapes {texts} must be equal or 1")
        if None in sizes and known:
            raise WidthFound(known[0])
        result.append(sizes.pop() if sizes else 1)
    return tuple(result)
