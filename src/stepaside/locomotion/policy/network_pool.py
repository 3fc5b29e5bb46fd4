"""Networks of many walkers, each loaded once."""

from collections.abc import Callable
from pathlib import Path

from .network import PolicyNetwork


class NetworkPool:
    """Networks in use, by file."""

    def __init__(self) -> None:
        """Begin without networks."""
        self._networks: dict[Path, PolicyNetwork] = {}
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

    def call_afterwards(self, function: Callable[[], None]) -> None:
        """Call a function at the end of the next :meth:`flush`."""
        self._afterwards.append(function)

    def flush(self) -> None:
        """Call what is to be called afterwards."""
        afterwards, self._afterwards = self._afterwards, []
        for function in afterwards:
            function()
