"""Address of a page: a listening socket and its host names."""

import errno
import socket
import threading
from dataclasses import dataclass
from ipaddress import ip_address
from typing import Any

from ...core.errors import ConfigurationError

RESOLUTION_TIMEOUT = 3.0  # of a host name, in [s]
PORTS = 100  # tried in turn while they are in use
LOCAL = frozenset({"127.0.0.1", "::1", "localhost"})


@dataclass(frozen=True, slots=True)
class PageAddress:
    """Listening socket with its address.

    Attributes:
        listening: The socket.
        host: Host as requested.
        ip: IP address of the host.
        port: Port.
    """

    listening: socket.socket
    host: str
    ip: str
    port: int

    @property
    def is_local(self) -> bool:
        """Whether it is a loopback address."""
        return ip_address(self.ip).is_loopback

    @property
    def is_everywhere(self) -> bool:
        """Whether it is all addresses of this machine."""
        return ip_address(self.ip).is_unspecified

    @property
    def url(self) -> str:
        """URL without a secret."""
        host = "127.0.0.1" if self.is_everywhere else self.host
        return f"http://{f'[{host}]' if ':' in host else host}:{self.port}"

    def answers_to(self, name: str) -> bool:
        """Return whether a name is one of this address.

        Another site can let its own name resolve to this machine (DNS
        rebinding), so that only known names count; numeric addresses cannot
        be rebound.

        Args:
            name: Host name, in lower case.
        """
        known = {self.host.lower(), self.ip}
        if self.is_local:
            return name in known | LOCAL
        if self.is_everywhere:
            known |= {*LOCAL, socket.gethostname().lower()}
        return name in known or (self.is_everywhere and _is_number(name))


def listen(host: str, port: int) -> PageAddress:
    """Listen at a port, or at the next free one.

    Args:
        host: Name or IP address of this machine.
        port: First port to try; 0 for any.

    Raises:
        ConfigurationError: If the host cannot be resolved or is not an
            address of this machine, or all ports are in use.
    """
    family, ip = _resolve(host)
    for tried in range(port, min(port + PORTS, 65536)):
        try:
            sock = socket.create_server((ip, tried), family=family)
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise _refused(host, error.strerror or str(error)) from error
        else:
            return PageAddress(sock, host, ip, sock.getsockname()[1])
    raise _refused(host, f"ports {port} to {port + PORTS - 1} are in use")


def _refused(host: str, reason: str) -> ConfigurationError:
    return ConfigurationError(
        f"host must be an address of this machine, got {host!r}: {reason}"
    )


def _resolve(host: str) -> tuple[Any, str]:
    """Return family and IP address of a host, within a timeout."""
    if not host.strip() or len(host) > 253:
        raise _refused(host[:40], "a name has 1 to 253 characters")
    found: list[Any] = []
    reason = [f"not resolved within {RESOLUTION_TIMEOUT:g} s"]

    def resolve() -> None:
        try:
            found.extend(
                socket.getaddrinfo(host, None, type=socket.SOCK_STREAM)
            )
        except (OSError, ValueError) as error:  # unknown or malformed name
            reason[0] = getattr(error, "strerror", None) or str(error)

    # A blocked name resolution cannot be cancelled.
    thread = threading.Thread(target=resolve, daemon=True)
    thread.start()
    thread.join(RESOLUTION_TIMEOUT)
    if not found:
        raise _refused(host, reason[0])
    family, _, _, _, address = found[0]
    return family, str(address[0]).split("%")[0]


def _is_number(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
