"""A connected socket that carries frames of a fixed size to us."""

import select
import socket
from typing import Any, Protocol

from ..guardian_process import SessionLost
from ..lola.lola_address import LolaAddress

CONNECTING = 5.0  # longest time to connect, in [s]
LONGEST_QUEUE = 1 << 20  # bytes of unread frames before it is hopeless


class FrameLink(Protocol):
    """What carries frames between a client and a robot."""

    def wait(self, timeout: float) -> bool:
        """Wait, in [s], until something arrived; whether it has."""

    def receive(self) -> list[Any]:
        """Whole frames that have arrived, oldest first, without waiting."""

    def send(self, data: Any) -> None:
        """Send one frame, at once and whole."""

    def close(self) -> None:
        """Let go of the other side."""


class SocketLink:
    """Frames of one size over a stream socket."""

    def __init__(self, connected: socket.socket, frame_bytes: int) -> None:
        """Take over a connected socket.

        Args:
            connected: The socket; it is closed with the link.
            frame_bytes: Size of every frame that arrives.
        """
        connected.setblocking(False)
        self._socket = connected
        self._size = frame_bytes
        self._buffer = bytearray()
        self._ended = False

    def wait(self, timeout: float) -> bool:
        """Wait, in [s], until something arrived; whether it has."""
        ready, _, _ = select.select([self._socket], [], [], max(timeout, 0.0))
        return bool(ready)

    def receive(self) -> list[bytes]:
        """Whole frames that have arrived, oldest first, without waiting.

        Raises:
            SessionLost: If the other side has closed or the queue is
                beyond all measure.
        """
        buffer = self._buffer
        while len(buffer) <= LONGEST_QUEUE:
            try:
                part = self._socket.recv(1 << 16)
            except (BlockingIOError, InterruptedError):
                break
            except OSError as error:
                raise SessionLost(f"the robot is gone: {error}") from error
            if not part:
                self._ended = True
                break
            buffer += part
        else:
            raise SessionLost("the robot sends more than can be read")
        whole = len(buffer) - len(buffer) % self._size
        if self._ended and not whole:
            raise SessionLost(
                "the robot closed the session"
                + (" in the middle of a frame" if buffer else "")
            )
        frames = [
            bytes(buffer[at : at + self._size])
            for at in range(0, whole, self._size)
        ]
        del buffer[:whole]
        return frames

    def send(self, data: bytes) -> None:
        """Send one frame, at once and whole.

        Raises:
            SessionLost: If the other side is gone or does not read.
        """
        try:
            sent = self._socket.send(data)
        except OSError as error:  # it is full, too, when nobody reads
            raise SessionLost(f"the robot takes no frame: {error}") from error
        if sent != len(data):
            raise SessionLost("the robot took a frame in part")

    @property
    def socket(self) -> socket.socket:
        """The connected socket."""
        return self._socket

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


def connect(
    address: LolaAddress, frame_bytes: int, timeout: float = CONNECTING
) -> SocketLink:
    """Connect to a robot.

    Args:
        address: Where it listens.
        frame_bytes: Size of its frames.
        timeout: Longest time that it may take, in [s].

    Raises:
        SessionLost: If nobody listens there.
    """
    opened = address.open()
    opened.settimeout(timeout)
    try:
        opened.connect(address.target)
    except OSError as error:
        opened.close()
        raise SessionLost(f"no robot listens at {address}: {error}") from error
    return SocketLink(opened, frame_bytes)
