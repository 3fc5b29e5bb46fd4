"""Addresses of robots on NAOqi."""

import re

from ...core.errors import ConfigurationError

SCHEME = "naoqi:"
PORT = 9559
# Key of a simulated robot beside NAOqi's own: age [s], bearing [rad] and
# distance [m] of the ideal sighting, which is ground truth.
IDEAL_SIGHT = "Stepaside/IdealSight"
_URL = re.compile(r"(?:tcp://)?(?P<host>[A-Za-z0-9_.-]+)(?::(?P<port>\d+))?")


def parse_url(text: str) -> str:
    """Parse ``tcp://HOST:PORT``, with or without the prefix ``naoqi:``.

    ``tcp://`` and the port, 9559, may be omitted.

    Raises:
        ConfigurationError: If it is not such an address.
    """
    found = _URL.fullmatch(text.removeprefix(SCHEME))
    port = int(found["port"] or PORT) if found and text.isascii() else 0
    if found is None or not 0 < port < 65536:
        raise ConfigurationError(
            f"robot must be naoqi:tcp://HOST:PORT, got {text!r}"
        )
    return f"tcp://{found['host']}:{port}"
