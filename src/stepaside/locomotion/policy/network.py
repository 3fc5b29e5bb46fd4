"""Network of a walking policy, evaluated by ONNX Runtime on one thread."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import PolicyError
from ...core.poses import Array


class TensorShape(NamedTuple):
    """Input or output of a network.

    Attributes:
        name: Its name.
        shape: Its shape; None for a size that the network leaves open.
    """

    name: str
    shape: tuple[int | None, ...]

    @property
    def width(self) -> int | None:
        """Size of the last axis."""
        return self.shape[-1] if self.shape else None

    def __str__(self) -> str:
        """Return name and shape, as in a message."""
        sizes = ("any" if size is None else str(size) for size in self.shape)
        return f"{self.name} [{', '.join(sizes)}]"


class PolicyNetwork:
    """Network that maps one observation to one action.

    Inputs after the first are recurrent states: each is fed back from the
    output of the same shape, in order, and is zero at the start.

    Attributes:
        path: File of the network.
        observation: First input.
        action: First output.
        states: Recurrent states, as pairs of input and output.
        metadata: Text entries that the exporter wrote.
    """

    def __init__(self, path: Path) -> None:
        """Load a network.

        Args:
            path: ONNX file.

        Raises:
            PolicyError: If the file is not an ONNX network with one
                observation and one action.
        """
        import onnxruntime

        self.path = path
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        options.log_severity_level = 4  # errors are raised, not printed
        try:
            self._session = onnxruntime.InferenceSession(
                path.read_bytes(), options, providers=["CPUExecutionProvider"]
            )
        except OSError as error:
            raise PolicyError(
                f"legs: cannot read {path}: {error.strerror}"
            ) from error
        except Exception as error:  # no common base in ONNX Runtime
            raise PolicyError(
                f"legs: {path} is not an ONNX network"
            ) from error
        inputs = [_shape_of(x) for x in self._session.get_inputs()]
        outputs = [_shape_of(x) for x in self._session.get_outputs()]
        self.metadata: Mapping[str, str] = dict(
            self._session.get_modelmeta().custom_metadata_map
        )
        self.observation, self.action = inputs[0], outputs[0]
        self.states = _pair_states(path, inputs[1:], outputs[1:])
        names = [self.action.name, *(out.name for _, out in self.states)]
        self._outputs = names
        self.reset()

    def reset(self) -> None:
        """Set the recurrent states to zero."""
        self._memory: dict[str, Any] = {
            given.name: np.zeros([size or 1 for size in given.shape], "f4")
            for given, _ in self.states
        }

    def evaluate(self, observation: Array) -> Array:
        """Return the action for an observation, and update the states.

        Args:
            observation: Shape (width of the input,).

        Returns:
            Shape (width of the output,).

        Raises:
            PolicyError: If an output is NaN or infinite.
        """
        feed = {self.observation.name: observation[None].astype(np.float32)}
        found = self._session.run(self._outputs, feed | self._memory)
        for (given, _), value in zip(self.states, found[1:], strict=True):
            self._memory[given.name] = value
        action: Array = found[0][0].astype(np.float64)
        if not np.isfinite(action).all():
            at = int(np.flatnonzero(~np.isfinite(action))[0])
            raise PolicyError(
                f"legs: output {at} of {self.path} must be finite, "
                f"got {action[at]}"
            )
        return action


def _shape_of(node: Any) -> TensorShape:
    sizes = (s if isinstance(s, int) else None for s in node.shape)
    return TensorShape(node.name, tuple(sizes))


def _pair_states(
    path: Path, inputs: list[TensorShape], outputs: list[TensorShape]
) -> tuple[tuple[TensorShape, TensorShape], ...]:
    """Pair each further input with the next output of its shape."""
    pairs, free = [], list(outputs)
    for given in inputs:
        fits = [out for out in free if out.shape == given.shape]
        if not fits:
            raise PolicyError(
                f"legs: input {given} of {path} is not a recurrent state: no "
                "output has its shape"
            )
        free.remove(fits[0])
        pairs.append((given, fits[0]))
    return tuple(pairs)
