"""Strategy that a network decides."""

from dataclasses import dataclass, field
from math import pi

import numpy as np

from ...core.errors import AnyPath, ConfigurationError, PolicyError, as_path
from ...core.poses import Array
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
        heading, speed = self.intents(observation[None])[0].tolist()
        return Intent(heading, speed) if speed > 0.0 else STAND, memory

    def intents(self, observations: Tensor) -> Array:
        """Return headings [rad] and speed factors for many observations.

        Args:
            observations: Shape (n, width of the observation).

        Returns:
            Shape (n, 2).

        Raises:
            PolicyError: If an output is NaN or infinite.
        """
        outputs = self.network.evaluate(observations).astype(np.float64)
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
    file = as_path(path, "path").expanduser()
    try:
        network = read_network(file)
        return LearnedStrategy(
            network, contract_of(network.metadata), file.name
        )
    except PolicyError as error:
        raise ConfigurationError(f"strategy {path}: {error}") from error
