"""Strategy that a network in an ONNX file decides, by ONNX Runtime."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import isfinite, pi
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.atomic_output import atomic_draft
from ...core.errors import AnyPath, ConfigurationError, PolicyError, as_path
from ...core.onnx_sessions import check_readable, open_session
from ...core.poses import Array
from ...planning import Direction
from ..knowledge import STAND, Intent, Knowledge
from .strategy_contract import StrategyContract, contract_of, observe

Tensor = NDArray[Any]
IR_VERSION, OPSET = 8, 17  # of the files that are written
KINDS = {
    "tensor(float16)": np.float16,
    "tensor(float)": np.float32,
    "tensor(double)": np.float64,
}
EXTERNAL = b"location"  # key of weights in a file beside the network


class OpenNetwork(NamedTuple):
    """Session of ONNX Runtime, with name and type of its input."""

    session: Any  # the session
    name: str  # name of its input
    kind: Any  # type of the numbers of its input
    rows: int | None  # that it takes at once; None for any
    width: int | None  # number of values of an observation; None for any

    @property
    def metadata(self) -> dict[str, str]:
        """Text entries of the file."""
        return dict(self.session.get_modelmeta().custom_metadata_map)

    def evaluate(self, observations: Tensor) -> Tensor:
        """Return a row of outputs for each of n observations, (n, width)."""
        given = np.asarray(observations, dtype=self.kind)
        if self.rows == 1 and len(given) != 1:
            return np.concatenate([self.evaluate(row[None]) for row in given])
        try:
            found: Tensor = self.session.run(None, {self.name: given})[0]
        except Exception as error:  # no common base in ONNX Runtime
            text = " ".join(str(error).split())
            raise PolicyError(f"the network cannot run: {text}") from error
        return found


@lru_cache(maxsize=32)
def open_network(content: bytes) -> OpenNetwork:
    """Return a network, from the content of an ONNX file, ready to run."""
    session = open_session(content)
    inputs, outputs = session.get_inputs(), session.get_outputs()
    if len(inputs) != 1 or len(outputs) != 1:
        raise PolicyError(
            "it must have one input and one output, got "
            f"{len(inputs)} and {len(outputs)}"
        )
    (port,) = inputs
    if port.type not in KINDS or len(port.shape) != 2:
        raise PolicyError(
            f"input {port.name} must be of {', '.join(KINDS)} with two axes, "
            f"got {port.type} of shape {port.shape}"
        )
    rows, width = (s if isinstance(s, int) else None for s in port.shape)
    return OpenNetwork(session, port.name, KINDS[port.type], rows, width)


def read_network(path: Path) -> bytes:
    """Return the content of an ONNX file, with weights that lie beside it."""
    check_readable(path)
    content = path.read_bytes()
    try:
        if EXTERNAL in content:
            import onnx

            try:
                content = onnx.load(path).SerializeToString()
            except Exception as error:  # of several libraries
                raise PolicyError(" ".join(str(error).split())) from error
        open_network(content)
    except PolicyError as error:
        raise PolicyError(f"{path} is not an ONNX network: {error}") from error
    return content


def dense_network(
    layers: Sequence[tuple[Tensor, Tensor]], *, activation: str = "Relu"
) -> bytes:
    """Return the content of an ONNX file of a dense network.

    Args:
        layers: Weights (inputs, outputs) and biases (outputs,) of each.
        activation: Operator between two layers, of those of ONNX.
    """
    from onnx import TensorProto, helper, numpy_helper

    nodes, weights, name = [], [], "observation"
    for n, layer in enumerate(layers):
        for key, values in zip(("weights", "biases"), layer, strict=True):
            tensor = np.asarray(values, dtype=np.float32)
            weights.append(numpy_helper.from_array(tensor, f"{key}_{n}"))
        is_last = n == len(layers) - 1
        out = "action" if is_last else f"sum_{n}"
        given = [name, f"weights_{n}", f"biases_{n}"]
        nodes.append(helper.make_node("Gemm", given, [out]))
        if not is_last:
            name = f"layer_{n}"
            nodes.append(helper.make_node(activation, [out], [name]))
    ports = [
        helper.make_tensor_value_info(port, TensorProto.FLOAT, ["batch", size])
        for port, size in (
            ("observation", np.shape(layers[0][0])[0]),
            ("action", np.shape(layers[-1][0])[1]),
        )
    ]
    model = helper.make_model(
        helper.make_graph(nodes, "strategy", ports[:1], ports[1:], weights),
        opset_imports=[helper.make_opsetid("", OPSET)],
        ir_version=IR_VERSION,
        producer_name="stepaside",
    )
    content: bytes = model.SerializeToString()
    return content


def with_metadata(content: bytes, entries: dict[str, str]) -> bytes:
    """Return the content of an ONNX file with text entries added."""
    import onnx

    model = onnx.load_from_string(content)
    kept = {each.key: each.value for each in model.metadata_props}
    del model.metadata_props[:]
    onnx.helper.set_model_props(model, {**kept, **entries})
    written: bytes = model.SerializeToString()
    return written


@dataclass(frozen=True, slots=True)
class LearnedStrategy:
    """Strategy whose intent is the output of a network."""

    saturated: ClassVar = False
    network: bytes = field(repr=False)  # content of an ONNX file
    contract: StrategyContract  # what it reads and what its outputs mean
    name: str = "network"  # name for messages, such as the file

    @property
    def _opened(self) -> OpenNetwork:
        return open_network(self.network)

    def __post_init__(self) -> None:
        """Check that the sizes of network and contract are equal."""
        width, network = self.contract.observation_width, self._opened
        if network.width not in (None, width):
            raise PolicyError(
                f"the observation must have {width} values for the terms "
                f"{', '.join(self.contract.terms)}, got {network.width}"
            )
        made = network.evaluate(np.zeros((1, width)))
        expected = (1, self.contract.action_width)
        if made.shape != expected:
            raise PolicyError(
                f"the network must have {expected[1]} outputs, got shape "
                f"{made.shape}"
            )

    @property
    def direction(self) -> Direction:
        """Direction of driving, from the contract."""
        return self.contract.direction

    def begin(self) -> None:
        """Return the memory: none."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Evaluate the network."""
        seen = observe(knowledge, self.contract.terms)[None]
        outputs = self._opened.evaluate(seen)[0].tolist()
        if not all(map(isfinite, outputs)):
            self.intents(seen)  # names the output
        headings = self.contract.headings
        if headings:
            heading = headings[outputs.index(max(outputs))]
            return STAND if heading is None else Intent(heading), memory
        heading, speed = outputs
        heading, speed = min(max(heading, -pi), pi), min(speed, 1.0)
        return Intent(heading, speed) if speed > 0.0 else STAND, memory

    def intents(self, observations: Tensor) -> Array:
        """Return heading [rad] and speed factor for each observation.

        Observations have shape (n, width), the result has (n, 2).
        """
        outputs = self._opened.evaluate(observations).astype(np.float64)
        if not np.isfinite(outputs).all():
            column = int(np.argwhere(~np.isfinite(outputs))[0][1])
            raise PolicyError(f"output {column} of {self.name} must be finite")
        headings = self.contract.headings
        rows: Array
        if not headings:
            rows = np.clip(outputs, (-pi, 0.0), (pi, 1.0))
            return rows
        table = [(h or 0.0, h is not None) for h in headings]
        rows = np.array(table, np.float64)[outputs.argmax(axis=1)]
        return rows

    def save(self, path: AnyPath) -> None:
        """Write the network with its contract as an ONNX file."""
        content = with_metadata(self.network, self.contract.metadata())
        with atomic_draft(as_path(path, "path")) as draft:
            draft.write_bytes(content)


def load_learned_strategy(path: AnyPath) -> LearnedStrategy:
    """Load a strategy from an ONNX file."""
    file = as_path(path, "path").expanduser()
    try:
        network = read_network(file)
        contract = contract_of(open_network(network).metadata)
        return LearnedStrategy(network, contract, file.name)
    except PolicyError as error:
        raise ConfigurationError(f"strategy {path}: {error}") from error
