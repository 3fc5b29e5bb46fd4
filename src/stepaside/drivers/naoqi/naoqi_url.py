"""Where NAOqi listens."""

import re

from ...core.errors import ConfigurationError

SCHEME = "naoqi:"
PORT = 9559
# What a simulated robot tells beside NAOqi's own keys: seconds since the
# other was seen, its bearing [rad] and distance [m]. It is the truth.
IDEAL_SIGHT = "Stepaside/IdealSight"
_URL = re.compile(r"(?:tcp://)?(?P<host>[A-Za-z0-9_.-]+)(?::(?P<port>\d+))?")


def parse_url(text: str) -> str:
    """Read ``tcp://HOST:PORT``, with or without ``naoqi:`` before it.

    ``tcp://`` and the port, 9559, may be left out.

    Raises:
        ConfigurationError: If it is none.
    """
    found = _URL.fullmatch(text.removeprefix(SCHEME))
    port = int(found["port"] or PORT) if found and text.isascii() else 0
    if found is None or not 0 < port < 65536:
        raise ConfigurationError(
            f"robot must be naoqi:tcp://HOST:PORT, got {text!r}"
        )
    return f"tcp://{found['host']}:{port}"
