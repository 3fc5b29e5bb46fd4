"""Strategy that a network decides."""

from dataclasses import dataclass, field
from math import isfinite, pi

import numpy as np

from ...core.errors import AnyPath, ConfigurationError, PolicyError, as_path
from ...planning import Direction
from ..knowledge import STAND, Intent, Knowledge
from .network_graph import NetworkGraph, Tensor, read_network
from .observation_terms import observe
from .strategy_contract import StrategyContract, contract_of


@dataclass(frozen=True, slots=True)
class LearnedStrategy:
    """Strategy whose intent is the output of a network.

    Attributes:
        network: The network.
        contract: What it reads and what its outputs mean.
        name: Name for messages, such as the file.
    """

    network: NetworkGraph = field(repr=False)
    contract: StrategyContract
    name: str = "network"

    def __post_init__(self) -> None:
        """Check that network and contract fit.

        Raises:
            PolicyError: If the sizes differ.
        """
        width = self.contract.observation_width
        if self.network.width not in (None, width):
            raise PolicyError(
                f"the observation must have {width} values for the terms "
                f"{', '.join(self.contract.terms)}, got {self.network.width}"
            )
        made = self.network.evaluate(np.zeros((1, width)))
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

    @property
    def saturated(self) -> bool:
        """False: it turns by (8)."""
        return False

    def begin(self) -> None:
        """Return the memory: none."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Evaluate the network.

        Raises:
            PolicyError: If an output is NaN or infinite.
        """
        observation = observe(knowledge, self.contract.terms)
        outputs = self.network.evaluate(observation[None])[0]
        return self._intent(outputs), memory

    def _intent(self, outputs: Tensor) -> Intent:
        """Return the intent that outputs mean."""
        values = outputs.astype(np.float64).tolist()
        for n, value in enumerate(values):
            if not isfinite(value):
                raise PolicyError(
                    f"output {n} of {self.name} must be finite, got {value}"
                )
        if not self.contract.headings:
            heading, speed = values
            speed = min(max(speed, 0.0), 1.0)
            return Intent(min(max(heading, -pi), pi), speed, speed > 0.0)
        chosen = self.contract.headings[int(np.argmax(outputs))]
        return STAND if chosen is None else Intent(chosen)

    def save(self, path: AnyPath) -> None:
        """Write the network with its contract as an ONNX file."""
        graph = self.network
        entries = {**graph.metadata, **self.contract.metadata()}
        NetworkGraph(
            graph.nodes,
            graph.constants,
            graph.input,
            graph.output,
            graph.width,
            entries,
        ).save(path)


def load_learned_strategy(path: AnyPath) -> LearnedStrategy:
    """Load a strategy from an ONNX file.

    Raises:
        ConfigurationError: If the file is not a strategy.
    """
    file = as_path(path, "strategy").expanduser()
    try:
        network = read_network(file)
        return LearnedStrategy(
            network, contract_of(network.metadata), file.name
        )
    except PolicyError as error:
        raise ConfigurationError(f"strategy {path}: {error}") from error
