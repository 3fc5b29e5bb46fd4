"""Listening socket with at most one client."""

import errno
import logging
import os
import socket
import stat
from contextlib import suppress
from tempfile import TemporaryDirectory

from ...core.errors import ConfigurationError
from .lola_address import EARLY, LolaAddress

log = logging.getLogger(__name__)


class ClientListener:
    """Listening socket that refuses a second client.

    Attributes:
        client: Socket of the connected client, if there is one.
        accepted: Number of clients so far.
        refused: Number of clients refused because one was connected.
    """

    def __init__(self, address: LolaAddress) -> None:
        """Listen; replace a stale socket at the path.

        Raises:
            ConfigurationError: If the address cannot be listened on.
        """
        self.address = address
        self.client: socket.socket | None = None
        self.accepted = self.refused = 0
        self._socket = address.open()
        self._inode: tuple[int, int] | None = None
        try:
            if address.path:
                _remove_stale(address)
                self._listen_at(address.path)
            else:
                self._socket.setsockopt(
                    socket.SOL_SOCKET, socket.SO_REUSEADDR, 1
                )
                self._socket.bind(address.target)
                self._socket.listen()
        except OSError as error:
            self._socket.close()
            raise ConfigurationError(
                f"cannot listen at {address}: {error}"
            ) from error
        self._socket.setblocking(False)

    def _listen_at(self, path: str) -> None:
        """Create a socket at a path, which already listens when it appears."""
        # In a temporary folder, where no other file is in the way. Unlike a
        # rename, a link does not replace an existing file.
        with TemporaryDirectory(
            prefix=".", dir=os.path.dirname(path) or "."
        ) as own:
            early = os.path.join(own, EARLY)
            self._socket.bind(early)
            self._socket.listen()
            self._inode = _inode(early)
            os.link(early, path)

    def accept(self) -> bool:
        """Accept waiting clients; return whether there is a new one."""
        is_new = False
        while True:
            try:
                arrived, _ = self._socket.accept()
            except (BlockingIOError, InterruptedError, ConnectionError):
                return is_new
            if self.client is not None:
                self.refused += 1
                log.warning("%s: a second client is refused", self.address)
                arrived.close()
                continue
            arrived.setblocking(False)
            if not self.address.path:
                arrived.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.client = arrived
            self.accepted += 1
            is_new = True

    def receive(self, limit: int) -> bytes:
        """Return bytes from the client, without waiting.

        Raises:
            ConnectionError: If the client has disconnected.
        """
        if self.client is None:
            return b""
        try:
            data = self.client.recv(limit)
        except (BlockingIOError, InterruptedError):
            return b""
        if not data:
            raise ConnectionResetError("closed by the client")
        return data

    def send(self, data: bytes) -> None:
        """Send all bytes to the client, if there is one, without waiting.

        Raises:
            ConnectionError: If the client has disconnected or does not read.
        """
        if self.client is None:
            return
        try:
            sent = self.client.send(data)
        except BlockingIOError as error:
            raise ConnectionAbortedError("it does not read") from error
        if sent != len(data):
            raise ConnectionAbortedError("it does not read")

    def drop(self, why: object) -> None:
        """Disconnect the client, if there is one, and log why."""
        if self.client is not None:
            log.warning("%s: client dropped: %s", self.address, why)
            self.client.close()
            self.client = None

    def close(self) -> None:
        """Disconnect the client and remove the socket."""
        if self.client is not None:
            self.client.close()
            self.client = None
        self._socket.close()
        path = self.address.path
        with suppress(OSError):
            if path and _inode(path) == self._inode:
                os.unlink(path)


def _inode(path: str) -> tuple[int, int]:
    found = os.lstat(path)
    return found.st_dev, found.st_ino


def _remove_stale(address: LolaAddress) -> None:
    """Remove a stale socket; refuse one that is in use."""
    path = address.path
    try:
        if not stat.S_ISSOCK(os.lstat(path).st_mode):
            raise OSError(errno.EEXIST, "a file of that name exists")
    except FileNotFoundError:
        return
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        probe.setblocking(False)
        try:
            probe.connect(path)
        except BlockingIOError:
            pass  # in use: its queue of clients is full
        except ConnectionRefusedError:
            os.unlink(path)
            return
    raise OSError(errno.EADDRINUSE, "another program listens there")
