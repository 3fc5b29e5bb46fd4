"""Learned strategies: a network in an ONNX file, with its contract.

Observations are free of units: lengths in units of v/k, speeds in units of v,
rates in units of k, with speed v and gain k of the own gait, in its path time.
So one network serves gaits of any size, in unicycles, in steps and in physics.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import cos, pi, sin
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.atomic_output import atomic_draft
from ..core.errors import (
    AnyPath,
    ConfigurationError,
    PolicyError,
    as_path,
    check_bearing,
)
from ..core.onnx_sessions import check_readable, open_session
from ..core.poses import Array
from ..planning import Direction
from .knowledge import STAND, Intent, Knowledge, Limits

Tensor = NDArray[Any]
FORMAT = "1"
LEAST, GREATEST = np.array([(-pi, 0.0), (pi, 1.0)])  # heading [rad], speed
HEADINGS = 15  # of discrete actions
FARTHEST = 8.0  # v/k
FASTEST = 4.0  # in v, and in k
CLEAREST = 2.0  # v/k
RINGS = (0.6, 1.6)  # radii of the points whose clearance is observed, in v/k
ANGLES = np.arange(8) * (0.25 * pi)  # of the points on each ring
RING_POINTS = np.array(
    [[0.0, 0.0], *([r * cos(a), r * sin(a)] for r in RINGS for a in ANGLES)]
)
"""Points of "clearances" in the own frame [v/k]. (17, 2)."""

IR_VERSION, OPSET = 8, 17  # of the files that are written
KINDS = {
    "tensor(float16)": np.float16,
    "tensor(float)": np.float32,
    "tensor(double)": np.float64,
}
EXTERNAL = b"location"  # key of weights in a file beside the network


class ObservedTerm(NamedTuple):
    """One quantity of an observation: number and range of its values."""

    width: int
    low: float
    high: float


SENSED_TERMS = {
    "distance": ObservedTerm(1, 0.0, FARTHEST),  # [v/k]
    # Cosine and sine of the bearing of the opponent.
    "bearing": ObservedTerm(2, -1.0, 1.0),
    # Turning rate of the line of sight over the floor [k]; 0 until known.
    "bearing_rate": ObservedTerm(1, -FASTEST, FASTEST),
    # Decrease of the distance [v]; 0 until known.
    "closing_speed": ObservedTerm(1, -FASTEST, FASTEST),
    "moving": ObservedTerm(1, 0.0, 1.0),  # 1 while the body walks, else 0
    # Clearance [v/k] of the own reference point, and of 8 points around it at
    # 0.6 v/k and 8 at 1.6 v/k, from ahead to the left.
    "clearances": ObservedTerm(len(RING_POINTS), -CLEAREST, CLEAREST),
}
"""Terms that the senses of a robot give, by name."""

FULL_STATE_TERMS = {
    # Cosine and sine of the own bearing from the opponent.
    "opponent_bearing": ObservedTerm(2, -1.0, 1.0),
    # Closest approach so far [v/k]; 0 after contact.
    "closest": ObservedTerm(1, 0.0, FARTHEST),
    "remaining": ObservedTerm(1, 0.0, 1.0),  # share of the game that is left
}
"""Further terms of learning environments, which no sense gives."""


def width_of(terms: Sequence[str]) -> int:
    """Return the number of values of an observation."""
    for name in terms:
        if name not in SENSED_TERMS:
            raise PolicyError(
                f"unknown observation term {name!r}; there are "
                f"{', '.join(SENSED_TERMS)}"
            )
    return sum(SENSED_TERMS[name].width for name in terms)


def length_unit(limits: Limits) -> float:
    """Return the unit of length, speed over gain, in [m]."""
    return limits.speed / limits.gain


def observe(known: Knowledge, terms: Sequence[str]) -> NDArray[np.float32]:
    """Return the values of terms, in order. Shape (width_of(terms),)."""
    limits, unit = known.limits, length_unit(known.limits)
    # Rates are sensed in gait time; gain and speed are those of path time.
    pace = limits.step_duration * limits.speed / limits.stride
    turning = (known.bearing_rate or 0.0) * pace / limits.gain
    closing = (known.closing_speed or 0.0) * pace / limits.speed
    values: dict[str, Sequence[float]] = {
        "distance": (min(known.distance / unit, FARTHEST),),
        "bearing": (cos(known.bearing), sin(known.bearing)),
        "bearing_rate": (min(max(turning, -FASTEST), FASTEST),),
        "closing_speed": (min(max(closing, -FASTEST), FASTEST),),
        "moving": (float(known.moving),),
        "clearances": (CLEAREST,) * len(RING_POINTS),
    }
    if known.obstacles_in_map and "clearances" in terms:
        points = known.pose_in_map.transform_points(unit * RING_POINTS)
        clear = known.obstacles_in_map.clearance(points) / unit
        values["clearances"] = np.clip(clear, -CLEAREST, CLEAREST).tolist()
    found = [value for name in terms for value in values[name]]
    return np.array(found, dtype=np.float32)


@dataclass(frozen=True, slots=True)
class StrategyContract:
    """Observation of a network, and meaning of its outputs."""

    direction: Direction  # of driving: forward, or backward
    terms: tuple[str, ...]  # in order; see :data:`SENSED_TERMS`
    # desired heading of each discrete action [rad], None to stand: the action
    # with the largest output is taken. Empty for continuous actions: the
    # outputs are a heading [rad], limited to half a turn, and a speed factor,
    # limited to [0, 1]
    headings: tuple[float | None, ...] = ()

    def __post_init__(self) -> None:
        """Check terms and headings."""
        width_of(self.terms)
        for heading in self.headings:
            if heading is not None:
                check_bearing(heading, "heading", PolicyError)

    @property
    def observation_width(self) -> int:
        """Number of values of an observation."""
        return width_of(self.terms)

    @property
    def action_width(self) -> int:
        """Number of outputs."""
        return len(self.headings) or 2

    def metadata(self) -> dict[str, str]:
        """Return the contract as text entries."""
        return {
            "stepaside_strategy": FORMAT,
            "direction": self.direction.name.lower(),
            "observation_names": json.dumps(self.terms),
            "action_headings": json.dumps(self.headings),
        }


def contract_of(metadata: Mapping[str, str]) -> StrategyContract:
    """Return the contract that the metadata of a network holds."""

    def entry(key: str, rule: str, read: Callable[[str], Any]) -> Any:
        try:
            return read(metadata[key])
        except (KeyError, TypeError, ValueError) as error:
            raise PolicyError(
                f"metadata {key} must be {rule}, got {metadata.get(key)!r:.40}"
            ) from error

    def listed(text: str) -> tuple[Any, ...]:
        return tuple(json.loads(text))

    entry("stepaside_strategy", FORMAT, (FORMAT,).index)
    return StrategyContract(
        entry(
            "direction",
            "forward or backward",
            lambda text: Direction[text.upper()],
        ),
        tuple(map(str, entry("observation_names", "a list", listed))),
        entry("action_headings", "a list", listed),
    )


def discrete_headings(number: int = HEADINGS) -> tuple[float | None, ...]:
    """Return evenly spaced headings, in [rad], and standing."""
    spaced = (pi * (2 * n + 1 - number) / number for n in range(number))
    return (*spaced, None)


class OpenNetwork(NamedTuple):
    """Session of ONNX Runtime, with name and type of its input."""

    session: Any
    name: str
    kind: Any  # of the numbers
    rows: Any  # that it takes at once; no number for any

    def evaluate(self, observations: Tensor) -> Tensor:
        """Return a row of outputs for each of n observations, (n, width)."""
        given = np.asarray(observations, dtype=self.kind)
        if self.rows == 1 and len(given) != 1:
            return np.concatenate([self.evaluate(row[None]) for row in given])
        try:
            found: Tensor = self.session.run(None, {self.name: given})[0]
        except Exception as error:  # no common base in ONNX Runtime
            text = " ".join(str(error).split())
            raise PolicyError(
                f"the network cannot run with {given.shape[1]} observed "
                f"values: {text}"
            ) from error
        return found


@lru_cache(maxsize=32)
def open_network(content: bytes) -> OpenNetwork:
    """Return a network, from the content of an ONNX file, ready to run."""
    session = open_session(content)
    kinds = [port.type for port in session.get_inputs()]
    if len(kinds) != 1 or kinds[0] not in KINDS:
        raise PolicyError(
            f"it must have one input of {', '.join(KINDS)}, got "
            f"{', '.join(kinds)}"
        )
    (port,) = session.get_inputs()
    return OpenNetwork(
        session, port.name, KINDS[port.type], next(iter(port.shape), None)
    )


def dense_network(
    layers: Sequence[tuple[Tensor, Tensor]], *, activation: str = "Relu"
) -> bytes:
    """Return the content of an ONNX file of a dense network.

    Args:
        layers: Weights (inputs, outputs) and biases (outputs,) of each.
        activation: Operator between two layers, of those of ONNX.
    """
    from onnx import numpy_helper, parser

    lines, weights, name = [], [], "observation"
    for n, layer in enumerate(layers):
        for key, values in zip(("weights", "biases"), layer, strict=True):
            tensor = np.asarray(values, dtype=np.float32)
            weights.append(numpy_helper.from_array(tensor, f"{key}_{n}"))
        out = "action" if n == len(layers) - 1 else f"sum_{n}"
        lines.append(f"{out} = Gemm({name}, weights_{n}, biases_{n})")
        if out != "action":
            name = f"layer_{n}"
            lines.append(f"{name} = {activation}({out})")
    shape = f"float[batch, {len(layers[0][0])}] observation"
    made = f"float[batch, {len(layers[-1][1])}] action"
    model = parser.parse_model(
        f'<ir_version: {IR_VERSION}, opset_import: ["": {OPSET}]>\n'
        f"strategy ({shape}) => ({made}) {{ {' '.join(lines)} }}"
    )
    model.graph.initializer.extend(weights)
    content: bytes = model.SerializeToString()
    return content


@dataclass(frozen=True, slots=True)
class LearnedStrategy:
    """Strategy whose intent is the output of a network."""

    saturated: ClassVar = False
    network: bytes = field(repr=False)  # content of an ONNX file
    contract: StrategyContract  # what it reads and what its outputs mean
    name: str = "network"  # name for messages, such as the file

    def __post_init__(self) -> None:
        """Check that the sizes of network and contract are equal."""
        nothing = np.zeros((1, self.contract.observation_width))
        made = open_network(self.network).evaluate(nothing)
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
        seen = observe(knowledge, self.contract.terms)
        heading, speed = self.intents(seen[None])[0].tolist()
        return Intent(heading, speed) if speed > 0.0 else STAND, memory

    def intents(self, observations: Tensor) -> Array:
        """Return heading [rad] and speed factor of n observations. (n, 2)."""
        outputs = open_network(self.network).evaluate(observations)
        if not np.isfinite(outputs).all():
            column = int(np.argwhere(~np.isfinite(outputs))[0][1])
            raise PolicyError(f"output {column} of {self.name} must be finite")
        if self.contract.headings:
            table = [(h or 0.0, h is not None) for h in self.contract.headings]
            rows: Array = np.array(table, np.float64)[outputs.argmax(axis=1)]
        else:
            rows = np.minimum(np.maximum(outputs, LEAST), GREATEST)
        return rows

    def save(self, path: AnyPath) -> None:
        """Write the network with its contract as an ONNX file."""
        import onnx

        model = onnx.load_from_string(self.network)
        entries = {each.key: each.value for each in model.metadata_props}
        del model.metadata_props[:]
        onnx.helper.set_model_props(model, entries | self.contract.metadata())
        with atomic_draft(as_path(path, "path")) as draft:
            draft.write_bytes(model.SerializeToString())


def load_learned_strategy(file: Path) -> LearnedStrategy:
    """Load a strategy from an ONNX file, with weights that lie beside it."""
    try:
        check_readable(file)
        network = file.read_bytes()
        if EXTERNAL in network:
            import onnx

            try:
                network = onnx.load(file).SerializeToString()
            except Exception as error:  # of several libraries
                raise PolicyError(" ".join(str(error).split())) from error
        metadata = open_network(network).session.get_modelmeta()
        contract = contract_of(metadata.custom_metadata_map)
        return LearnedStrategy(network, contract, file.name)
    except PolicyError as error:
        raise ConfigurationError(f"strategy {file}: {error}") from error
