"""Interface of links that carry frames to and from a robot."""

from typing import Any, Protocol


class FrameLink(Protocol):
    """Connection that carries frames between a client and a robot."""

    def wait(self, timeout: float) -> bool:
        """Wait up to ``timeout``, in [s]; return whether data arrived."""

    def receive(self) -> list[Any]:
        """Return complete frames, oldest first, without waiting."""

    def send(self, data: Any) -> None:
        """Send one complete frame without waiting."""

    def close(self) -> None:
        """Disconnect."""
