"""Where a robot listens: a Unix path or a TCP port."""

import socket
from dataclasses import dataclass

from ...core.errors import ConfigurationError

SCHEME = "lola:"
ON_THE_ROBOT = "/tmp/robocup"  # where every NAO V6 listens
SIGHT_SUFFIX = ".ideal-sight"  # where a simulated robot offers the truth
CAMERAS_SUFFIX = ".cameras"  # where it shows what its cameras see
EARLY = "s"  # in a folder of its own, of a socket that does not listen yet
LONGEST_PATH = 107 - len(SIGHT_SUFFIX) - len("/.12345678/s")  # in bytes


@dataclass(frozen=True, slots=True)
class LolaAddress:
    """A Unix path, or a host and a TCP port.

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
        """Where the ideal line of sight is offered; Unix paths only."""
        return LolaAddress(self.path + SIGHT_SUFFIX) if self.path else None

    @property
    def cameras(self) -> "LolaAddress | None":
        """Where a simulated robot's images are offered; Unix paths only."""
        return LolaAddress(self.path + CAMERAS_SUFFIX) if self.path else None

    def open(self) -> socket.socket:
        """A socket of the right kind, not yet connected or bound."""
        family = socket.AF_UNIX if self.path else socket.AF_INET
        opened = socket.socket(family, socket.SOCK_STREAM)
        if not self.path:
            opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return opened

    @property
    def target(self) -> str | tuple[str, int]:
        """What connect and bind take."""
        return self.path or (self.host, self.port)


def parse_address(text: str) -> LolaAddress:
    """Read ``PATH`` or ``HOST:PORT``, with or without ``lola:`` before it.

    Nothing but ``lola:`` means the path of the robot itself. What holds no
    slash and ends in a colon and a number is a host and a port.

    Raises:
        ConfigurationError: If it is neither.
    """
    place = text.removeprefix(SCHEME) or ON_THE_ROBOT
    host, colon, port = place.rpartition(":")
    if not colon or "/" in place:
        if len(place.encode()) > LONGEST_PATH:
            raise ConfigurationError(
                f"path of a socket must be shorter, got {place!r}"
            )
        return LolaAddress(path=place)
    if not host or not port.isascii() or not port.isdigit():
        raise ConfigurationError(
            f"robot must be lola:PATH or lola:HOST:PORT, got {text!r}"
        )
    if not 0 < int(port) < 65536:
        raise ConfigurationError(f"port must lie in [1, 65535], got {port}")
    return LolaAddress(host=host, port=int(port))
