"""Joystick and gamepad input of the live page.

viser has no analogue control. A script on its page draws a joystick on touch
screens, reads a gamepad, and sends the position of either in HTTP requests.
"""

from collections.abc import Callable
from http import HTTPStatus
from math import isfinite
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from .script_injection import Answer, PageScripts, respond

Steer = Callable[[float, bool], None]
HEADER = "X-Stepaside"  # that pages of other origins cannot send
SCRIPT = "stick.js"


class GamepadInput:
    """Handler of joystick requests, inactive until it is connected."""

    def __init__(self, scripts: PageScripts) -> None:
        """Start without a receiver.

        Args:
            scripts: Scripts of the page; the joystick's is added to them.
        """
        self._scripts = scripts
        self._steer: Steer | None = None

    def connect(self, steer: Steer) -> None:
        """Show the joystick and send its position to a receiver.

        Args:
            steer: Takes the turn, from -1 (right) to 1 (left), and whether
                to walk.
        """
        self._steer = steer
        self._scripts.add(SCRIPT)

    def handle(self, answer: Answer) -> Answer:
        """Return a request handler that also answers the joystick's requests.

        Args:
            answer: Handler of all other requests.
        """

        def answered(
            connection: ServerConnection, request: Request
        ) -> Response | None:
            active = self._steer and "Upgrade" not in request.headers
            if active and urlsplit(request.path).path == "/hand":
                return self._receive(request)
            return answer(connection, request)

        return answered

    def _receive(self, request: Request) -> Response:
        """Steer as requested, if the request comes from a page served here."""
        position = parse_position(urlsplit(request.path).query)
        headers = request.headers.get_all(HEADER)
        if position is None or len(headers) != 1 or self._steer is None:
            return respond(b"", "text/plain", HTTPStatus.BAD_REQUEST)
        self._steer(*position)
        return respond(b"", "text/plain")


def parse_position(query: str) -> tuple[float, bool] | None:
    """Return turn, -1 to 1, and whether to walk; None if invalid.

    Args:
        query: Query string, like ``turn=0.5&going=1``.
    """
    try:
        fields = parse_qs(query, strict_parsing=True, max_num_fields=2)
        [turn_text], [going] = fields["turn"], fields["going"]
        turn = float(turn_text)
    except (KeyError, ValueError):
        return None
    if not isfinite(turn) or abs(turn) > 1.0 or going not in ("0", "1"):
        return None
    return turn, going == "1"
