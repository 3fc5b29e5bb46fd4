"""Addresses of robots on LoLA: a Unix path, or a host and TCP port."""

import socket
from dataclasses import dataclass

from ...core.errors import ConfigurationError

SCHEME = "lola:"
DEFAULT_PATH = "/tmp/robocup"  # socket of every NAO V6
SIGHT_SUFFIX = ".ideal-sight"  # of a simulated robot's ground truth channel
EARLY = "s"  # temporary name of a socket before it listens
MAX_PATH = 107 - len(SIGHT_SUFFIX) - len("/.12345678/s")  # in bytes


@dataclass(frozen=True, slots=True)
class LolaAddress:
    """Unix path, or host and TCP port.

    Attributes:
        path: Path of the socket; empty for TCP.
        host: Host; empty for a path.
        port: TCP port.
    """

    path: str = ""
    host: str = ""
    port: int = 0

    def __str__(self) -> str:
        return self.path or f"{self.host}:{self.port}"

    @property
    def sight(self) -> "LolaAddress | None":
        """Address of the ideal line of sight; None for TCP."""
        return LolaAddress(self.path + SIGHT_SUFFIX) if self.path else None

    def open(self) -> socket.socket:
        """Create a socket of the address's family, not connected or bound."""
        family = socket.AF_UNIX if self.path else socket.AF_INET
        opened = socket.socket(family, socket.SOCK_STREAM)
        if not self.path:
            opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return opened

    @property
    def target(self) -> str | tuple[str, int]:
        """Argument of the socket's methods ``connect`` and ``bind``."""
        return self.path or (self.host, self.port)


def parse_address(text: str) -> LolaAddress:
    """Parse ``PATH`` or ``HOST:PORT``, with or without the prefix ``lola:``.

    ``lola:`` alone is the path of a real robot. A text with a colon and
    without a slash is a host and port.

    Raises:
        ConfigurationError: If it is neither.
    """
    location = text.removeprefix(SCHEME) or DEFAULT_PATH
    host, colon, port = location.rpartition(":")
    if not colon or "/" in location:
        if len(location.encode()) > MAX_PATH:
            raise ConfigurationError(
                f"path of a socket must have at most {MAX_PATH} bytes, got "
                f"{location!r}"
            )
        return LolaAddress(path=location)
    if not host or not port.isascii() or not port.isdigit():
        raise ConfigurationError(
            f"robot must be lola:PATH or lola:HOST:PORT, got {text!r}"
        )
    if not 0 < int(port) < 65536:
        raise ConfigurationError(f"port must lie in [1, 65535], got {port}")
    return LolaAddress(host=host, port=int(port))
