"""Networks of many walkers, evaluated for all of them at once."""

from collections.abc import Callable
from pathlib import Path

from ...core.poses import Array
from .network import Memory, PolicyNetwork

Receiver = Callable[[Array, Memory], object]


class NetworkPool:
    """Networks in use, by file, with the observations that wait for them.

    Walkers submit observations during a control tick; one evaluation of each
    network then serves all of them, in one world or in many.
    """

    def __init__(self) -> None:
        """Begin without networks."""
        self._networks: dict[Path, PolicyNetwork] = {}
        self._waiting: dict[
            PolicyNetwork, list[tuple[Array, Memory, Receiver]]
        ] = {}
        self._afterwards: list[Callable[[], None]] = []

    def load(self, path: Path) -> PolicyNetwork:
        """Return the network of a file; walkers share it.

        Raises:
            PolicyError: If the file is not such a network.
        """
        key = path.resolve()
        if key not in self._networks:
            self._networks[key] = PolicyNetwork(path)
        return self._networks[key]

    def submit(
        self,
        network: PolicyNetwork,
        observation: Array,
        memory: Memory,
        receive: Receiver,
    ) -> None:
        """Evaluate an observation at the next :meth:`flush`.

        Args:
            network: Network of this pool.
            observation: Shape (width of the input,).
            memory: Recurrent states of the walker.
            receive: Function of action and new recurrent states.
        """
        request = observation, memory, receive
        self._waiting.setdefault(network, []).append(request)

    def call_afterwards(self, function: Callable[[], None]) -> None:
        """Call a function at the end of the next :meth:`flush`."""
        self._afterwards.append(function)

    def flush(self) -> None:
        """Evaluate all that waits, and call what is to be called afterwards.

        Raises:
            PolicyError: If an output of a network is NaN or infinite.
        """
        waiting, self._waiting = self._waiting, {}
        for network, requests in waiting.items():
            observations, memories, receivers = zip(*requests, strict=True)
            answers = network.evaluate(observations, memories)
            for receive, answer in zip(receivers, answers, strict=True):
                receive(*answer)
        afterwards, self._afterwards = self._afterwards, []
        for function in afterwards:
            function()
