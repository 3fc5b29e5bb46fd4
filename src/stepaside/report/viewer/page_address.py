"""Where a page is served: a socket that listens, and the names it has."""

import errno
import socket
import threading
from dataclasses import dataclass
from ipaddress import ip_address
from typing import Any

from ...core.errors import ConfigurationError

PATIENCE = 3.0  # with the resolution of a name, in [s]
PORTS = 100  # tried one after the other, while they are taken
LOCAL = frozenset({"127.0.0.1", "::1", "localhost"})


@dataclass(frozen=True, slots=True)
class PageAddress:
    """A place that listens.

    Attributes:
        listening: The socket.
        host: As it was asked for.
        ip: What it was resolved to.
        port: Where it listens.
    """

    listening: socket.socket
    host: str
    ip: str
    port: int

    @property
    def is_local(self) -> bool:
        """Whether only this machine reaches it."""
        return ip_address(self.ip).is_loopback

    @property
    def is_everywhere(self) -> bool:
        """Whether it is every address of this machine."""
        return ip_address(self.ip).is_unspecified

    @property
    def url(self) -> str:
        """Link to it, without a secret."""
        host = "127.0.0.1" if self.is_everywhere else self.host
        return f"http://{f'[{host}]' if ':' in host else host}:{self.port}"

    def answers_to(self, name: str) -> bool:
        """Whether a name, in small letters, is one of this place.

        A page of elsewhere can have its own name resolved to this machine,
        so a name counts only if it is known; numbers cannot be so bent.
        """
        known = {self.host.lower(), self.ip}
        if self.is_local:
            return name in known | LOCAL
        if self.is_everywhere:
            known |= {*LOCAL, socket.gethostname().lower()}
        return name in known or (self.is_everywhere and _is_number(name))


def listen(host: str, port: int) -> PageAddress:
    """Listen at a port, or at the next that is free.

    Args:
        host: Name or number of an address of this machine.
        port: First one to try; 0 for any.

    Raises:
        ConfigurationError: If the host has no address, or is not here.
    """
    family, ip = _resolved(host)
    for tried in range(port, min(port + PORTS, 65536)):
        try:
            sock = socket.create_server((ip, tried), family=family)
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise _refused(host, error.strerror or str(error)) from error
        else:
            return PageAddress(sock, host, ip, sock.getsockname()[1])
    raise _refused(host, f"ports {port} to {port + PORTS - 1} are taken")


def _refused(host: str, why: str) -> ConfigurationError:
    return ConfigurationError(
        f"host must be an address of this machine, got {host!r}: {why}"
    )


def _resolved(host: str) -> tuple[Any, str]:
    """Family and number of a host; names that take long have none."""
    if not host.strip() or len(host) > 253:
        raise _refused(host[:40], "no name is empty or so long")
    found: list[Any] = []
    why = [f"not resolved within {PATIENCE:g} s"]

    def resolve() -> None:
        try:
            found.extend(
                socket.getaddrinfo(host, None, type=socket.SOCK_STREAM)
            )
        except (OSError, ValueError) as error:  # no address, or no name
            why[0] = getattr(error, "strerror", None) or str(error)

    # What asks far away for a name cannot be told to stop.
    asking = threading.Thread(target=resolve, daemon=True)
    asking.start()
    asking.join(PATIENCE)
    if not found:
        raise _refused(host, why[0])
    family, _, _, _, place = found[0]
    return family, str(place[0]).split("%")[0]


def _is_number(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
