"""Network of a walking policy, evaluated by ONNX Runtime on one thread."""

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PolicyError
from ...core.onnx_sessions import check_readable, open_session
from ...core.poses import Array

Memory = tuple[NDArray[np.floating[Any]], ...]  # states of one walker
KINDS: Mapping[str, type[np.floating[Any]]] = {
    "tensor(float16)": np.float16,
    "tensor(float)": np.float32,
    "tensor(double)": np.float64,
}
LARGEST_ACTION = 1e4  # beyond, a simulation becomes unstable
DIRECTIONS = {"in", "out", "input", "output", "prev", "next", "new", "old"}
BATCHES = 2, 5, 16, 33  # numbers of rows in which bits are compared


class TensorShape(NamedTuple):
    """Input or output of a network.

    Attributes:
        name: Its name.
        shape: Its shape; None for a size that the network leaves open.
        kind: Type of its numbers, as ONNX Runtime writes it.
    """

    name: str
    shape: tuple[int | None, ...]
    kind: str = "tensor(float)"

    @property
    def width(self) -> int | None:
        """Size of the last axis."""
        return self.shape[-1] if self.shape else None

    def __str__(self) -> str:
        """Return name and shape, as in a message."""
        sizes = ("any" if size is None else str(size) for size in self.shape)
        return f"{self.name} [{', '.join(sizes)}]"

    @property
    def batch_axis(self) -> int | None:
        """Axis of the walkers: one left open, else the last but one.

        None for a single row of values.
        """
        leading = self.shape[:-1]
        if None in leading:
            return leading.index(None)
        return len(leading) - 1 if leading else None

    def zeros(self, count: int) -> NDArray[np.floating[Any]]:
        """Return zeros for a number of walkers."""
        sizes = [size or 1 for size in self.shape]
        if self.batch_axis is not None:
            sizes[self.batch_axis] = count
        return np.zeros(sizes, KINDS[self.kind])


class PolicyNetwork:
    """Network that maps observations to actions, of one walker or of many.

    Inputs beside the observation are recurrent states: each is fed back from
    the output of its name and shape, see :func:`_stem`, and is zero at the
    start.

    Networks are exported for one walker. Their batch axis is freed, and
    several walkers are evaluated at once where this gives the same bits;
    otherwise each is evaluated by itself.

    Attributes:
        path: File of the network.
        observation: Input that is no recurrent state.
        action: First output that is none.
        states: Recurrent states, as pairs of input and output.
        metadata: Text entries that the exporter wrote.
        draws: Whether outputs differ for the same input.
    """

    def __init__(self, path: Path) -> None:
        """Load a network.

        Args:
            path: ONNX file.

        Raises:
            PolicyError: If the file is not an ONNX network with one
                observation and one action.
        """
        self.path = path
        try:
            check_readable(path)
        except PolicyError as error:
            raise PolicyError(f"legs: {error}") from error
        try:
            self._session = open_session(str(path))
        except PolicyError as error:
            raise PolicyError(
                f"legs: {path} is not an ONNX network: {error}"
            ) from error
        ports = self._session.get_inputs(), self._session.get_outputs()
        self.metadata: Mapping[str, str] = dict(
            self._session.get_modelmeta().custom_metadata_map
        )
        pairs = _pair_ports(path, *([_shape_of(x) for x in p] for p in ports))
        (self.observation, self.action), *self.states = pairs
        self._outputs = [out.name for _, out in pairs]
        self._inputs = [given for given, _ in pairs]
        for port in (port for pair in pairs for port in pair):
            if port.kind not in KINDS:
                raise PolicyError(
                    f"legs: {port.name} of {path} must be of "
                    f"{', '.join(KINDS)}, got {port.kind}"
                )
            if not 1 <= len(port.shape) <= 3:
                raise PolicyError(
                    f"legs: {port} of {path} must have one to three axes"
                )
        self._bindings: dict[int, _BoundArrays] = {}
        self.draws = self._try()

    def _try(self) -> bool:
        """Evaluate once, and again to see whether outputs repeat."""
        draw = np.random.default_rng(0).standard_normal
        feed = {}
        for port in self._inputs:
            zeros = port.zeros(1)
            feed[port.name] = draw(zeros.shape).astype(zeros.dtype)
        try:
            once, again = (
                self._session.run(self._outputs, feed) for _ in range(2)
            )
        except Exception as error:  # no common base in ONNX Runtime
            raise PolicyError(
                f"legs: {self.path} cannot run for one walker: "
                + " ".join(str(error).split())
            ) from error
        width = once[0].size
        self.action = self.action._replace(shape=(1, width))
        return any(
            not np.array_equal(*both, equal_nan=True)
            for both in zip(once, again, strict=True)
        )

    def initial_memory(self) -> Memory:
        """Return recurrent states of zero, for one walker."""
        return tuple(given.zeros(1) for given, _ in self.states)

    def evaluate(
        self, observations: Sequence[Array], memories: Sequence[Memory]
    ) -> list[tuple[Array, Memory]]:
        """Return actions and new recurrent states of some walkers.

        Args:
            observations: Observation of each. Shape (width of the input,).
            memories: Recurrent states of each.

        Raises:
            PolicyError: If an output is NaN, infinite or huge.
        """
        if len(observations) == 1:
            return self._run(self._session, observations, memories)
        if self._batched is not None:
            return self._run(self._batched, observations, memories)
        return [
            self._run(self._session, [seen], [memory])[0]
            for seen, memory in zip(observations, memories, strict=True)
        ]

    @cached_property
    def _batched(self) -> Any:
        """Session for many walkers; None if it would give other bits."""
        with suppress(Exception):
            batched = open_session(_with_free_batch(self.path))
            if self._gives_equal_bits(batched):
                return batched
        return None

    def _run(
        self,
        session: Any,
        observations: Sequence[Array],
        memories: Sequence[Memory],
    ) -> list[tuple[Array, Memory]]:
        """Evaluate walkers together."""
        count = len(observations)
        bound = self._bindings.get(count)
        if bound is None:
            bound = _BoundArrays(session, self._inputs, self._outputs, count)
            self._bindings[count] = bound
        rows = bound.inputs[0].reshape(count, -1)  # a view
        for row, observation in zip(rows, observations, strict=True):
            row[:] = observation
        for i, (given, _) in enumerate(self.states):
            if given.batch_axis is None:
                bound.inputs[1 + i][:] = memories[0][i]
                continue
            np.concatenate(
                [memory[i] for memory in memories],
                axis=given.batch_axis,
                out=bound.inputs[1 + i],
            )
        session.run_with_iobinding(bound.binding)
        found = bound.outputs
        actions: Array = found[0].astype(np.float64).reshape(count, -1)
        flat = actions.ravel()
        if not flat @ flat < 0.5 * LARGEST_ACTION**2:  # faster than for each
            self._check(actions)
        if not self.states:
            return [(action, ()) for action in actions]
        split = [
            np.split(value.copy(), count, axis=given.batch_axis or 0)
            for (given, _), value in zip(self.states, found[1:], strict=True)
        ]
        return list(zip(actions, zip(*split, strict=True), strict=True))

    def _check(self, actions: Array) -> None:
        """Refuse actions that are NaN, infinite or huge."""
        usable = np.abs(actions) <= LARGEST_ACTION  # NaN is not
        if not usable.all():
            row, at = np.argwhere(~usable)[0].tolist()
            raise PolicyError(
                f"legs: output {at} of {self.path} must be finite and at most "
                f"{LARGEST_ACTION:g}, got {actions[row, at]:g}"
            )

    def _gives_equal_bits(self, batched: Any) -> bool:
        """Compare a session with a free batch axis to that for one walker."""
        draw = np.random.default_rng(0).standard_normal
        for count in BATCHES:
            together = {}
            for port in self._inputs:
                zeros = port.zeros(count)
                together[port.name] = draw(zeros.shape).astype(zeros.dtype)
            outputs = batched.run(self._outputs, together)
            axes = [port.batch_axis for port in self._inputs]
            for k in range(count):
                feed = {
                    port.name: np.take(together[port.name], [k], axis=axis)
                    for port, axis in zip(self._inputs, axes, strict=True)
                }
                alone = self._session.run(self._outputs, feed)
                for one, all_, axis in zip(alone, outputs, axes, strict=True):
                    if not np.array_equal(one, np.take(all_, [k], axis=axis)):
                        return False
        return True


class _BoundArrays:
    """Inputs and outputs of a session, which reads and writes them in place.

    Passing arrays at each call takes a third longer.

    Attributes:
        inputs: Inputs, to be filled.
        outputs: Outputs of the last run.
        binding: Binding of the session to them.
    """

    def __init__(
        self,
        session: Any,
        shapes: Sequence[TensorShape],
        outputs: Sequence[str],
        count: int,
    ) -> None:
        """Bind new arrays for a number of walkers."""
        self.inputs = [shape.zeros(count) for shape in shapes]
        names = [shape.name for shape in shapes]
        # Networks may leave sizes of outputs open: a run shows them.
        self.outputs: list[NDArray[np.floating[Any]]] = session.run(
            outputs, dict(zip(names, self.inputs, strict=True))
        )
        self.binding = session.io_binding()
        for bind, keys, arrays in (
            (self.binding.bind_input, names, self.inputs),
            (self.binding.bind_output, outputs, self.outputs),
        ):
            for key, array in zip(keys, arrays, strict=True):
                place = array.__array_interface__["data"][0]
                bind(key, "cpu", 0, array.dtype.type, array.shape, place)


def _with_free_batch(path: Path) -> bytes:
    """Return an ONNX network whose inputs may have any number of rows."""
    import onnx

    model = onnx.load(path)
    for node in (*model.graph.input, *model.graph.output):
        sizes = node.type.tensor_type.shape.dim
        if all(size.HasField("dim_value") for size in sizes[:-1]):
            sizes[-2].ClearField("dim_value")
            sizes[-2].dim_param = "walkers"
    del model.graph.value_info[:]
    freed: bytes = model.SerializeToString()
    return freed


def _shape_of(node: Any) -> TensorShape:
    sizes = (s if isinstance(s, int) else None for s in node.shape)
    return TensorShape(node.name, tuple(sizes), node.type)


def _stem(port: TensorShape) -> str:
    """Return what the names of a state's input and output share.

    They are like "h_in" and "h_out", or "h0" and "hn".
    """
    words = re.split(r"[^a-z0-9]+", port.name.lower())
    return "_".join(w for w in words if w not in DIRECTIONS).rstrip("0n")


def _fit(one: TensorShape, other: TensorShape) -> bool:
    """Return whether two shapes may be the same."""
    return len(one.shape) == len(other.shape) and all(
        a == b or None in (a, b)
        for a, b in zip(one.shape, other.shape, strict=True)
    )


def _pair_ports(
    path: Path, inputs: list[TensorShape], outputs: list[TensorShape]
) -> list[tuple[TensorShape, TensorShape]]:
    """Pair the observation with the action, then states with their outputs.

    A state whose name tells nothing has the only output of its shape.
    """
    named = [
        (given, out)
        for given in inputs
        for out in outputs
        if _stem(given) == _stem(out) != "" and _fit(given, out)
    ]
    rest = [x for x in inputs if x not in [given for given, _ in named]]
    free = [x for x in outputs if x not in [out for _, out in named]]
    if not (rest and free):
        raise PolicyError(
            f"legs: {path} must have an observation and an action beside its "
            "recurrent states"
        )
    pairs = [(rest[0], free[0])]
    for given in rest[1:]:
        fits = [out for out in free[1:] if _fit(given, out)]
        if len(fits) != 1:
            names = ", ".join(map(str, free[1:])) or "none"
            raise PolicyError(
                f"legs: input {given} of {path} must be fed back from one "
                f"output of its name, like h_in from h_out, or of its shape, "
                f"got {names}"
            )
        pairs.append((given, fits[0]))
    return pairs + named
