"""Strategy that a network decides."""

from dataclasses import dataclass, field
from math import isfinite, pi
from typing import ClassVar

import numpy as np

from ...core.atomic_output import atomic_draft
from ...core.errors import AnyPath, ConfigurationError, PolicyError, as_path
from ...core.poses import Array
from ...planning import Direction
from ..knowledge import STAND, Intent, Knowledge
from .decision_network import (
    OpenNetwork,
    Tensor,
    open_network,
    read_network,
    with_metadata,
)
from .strategy_contract import StrategyContract, contract_of, observe


@dataclass(frozen=True, slots=True)
class LearnedStrategy:
    """Strategy whose intent is the output of a network."""

    saturated: ClassVar = False
    # content of an ONNX file, as of :func:`dense_network`
    network: bytes = field(repr=False)
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
