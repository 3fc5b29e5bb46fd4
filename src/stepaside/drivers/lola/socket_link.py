"""Link of fixed-size frames over a stream socket."""

import select
import socket

from ..guardian_process import SessionLost
from .lola_address import LolaAddress

CONNECT_TIMEOUT = 5.0  # in [s]
MAX_QUEUE = 1 << 20  # unread frames after which the session ends, in bytes


class SocketLink:
    """Link of frames of a fixed size over a stream socket."""

    def __init__(self, connected: socket.socket, frame_bytes: int) -> None:
        """Use a connected socket.

        Args:
            connected: Socket; closed with the link.
            frame_bytes: Size of each received frame, in bytes.
        """
        connected.setblocking(False)
        self._socket = connected
        self._size = frame_bytes
        self._buffer = bytearray()
        self._ended = False

    def wait(self, timeout: float) -> bool:
        """Wait up to ``timeout``, in [s]; return whether data arrived."""
        ready, _, _ = select.select([self._socket], [], [], max(timeout, 0.0))
        return bool(ready)

    def receive(self) -> list[bytes]:
        """Return complete frames, oldest first, without waiting.

        Raises:
            SessionLost: If the robot has closed the connection, or too many
                frames are queued.
        """
        buffer = self._buffer
        while len(buffer) <= MAX_QUEUE:
            try:
                part = self._socket.recv(1 << 16)
            except (BlockingIOError, InterruptedError):
                break
            except OSError as error:
                raise SessionLost(
                    f"the connection to the robot failed: {error}"
                ) from error
            if not part:
                self._ended = True
                break
            buffer += part
        else:
            raise SessionLost(
                f"more than {MAX_QUEUE} bytes from the robot are unread"
            )
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
        """Send one complete frame without waiting.

        Raises:
            SessionLost: If the robot has disconnected or does not read.
        """
        try:
            sent = self._socket.send(data)
        except OSError as error:  # including a full buffer
            raise SessionLost(f"cannot send to the robot: {error}") from error
        if sent != len(data):
            raise SessionLost(
                f"the robot read {sent} of {len(data)} bytes of a frame"
            )

    @property
    def socket(self) -> socket.socket:
        """The connected socket."""
        return self._socket

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


def connect(
    address: LolaAddress, frame_bytes: int, timeout: float = CONNECT_TIMEOUT
) -> SocketLink:
    """Connect to a robot.

    Args:
        address: Address of the robot.
        frame_bytes: Size of the robot's frames, in bytes.
        timeout: Timeout of the connection, in [s].

    Raises:
        SessionLost: If no robot listens there.
    """
    opened = address.open()
    opened.settimeout(timeout)
    try:
        opened.connect(address.target)
    except OSError as error:
        opened.close()
        raise SessionLost(f"no robot listens at {address}: {error}") from error
    return SocketLink(opened, frame_bytes)
