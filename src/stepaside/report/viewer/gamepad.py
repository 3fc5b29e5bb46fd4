"""A stick and a gamepad for the live page, which viser itself lacks.

viser has no control that says how far something is held to one side. A script
on its page draws a stick where fingers point, reads a gamepad, and tells how
both are held in requests of its own.
"""

from collections.abc import Callable
from http import HTTPStatus
from math import isfinite
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from .page_scripts import Answer, PageScripts, respond

Steer = Callable[[float, bool], None]
ASKS = "X-Stepaside"  # a header that only a page of this place can send
STICK = "stick.js"


class GamepadInput:
    """Answers the stick of a page, once somebody attends to it."""

    def __init__(self, scripts: PageScripts) -> None:
        """Begin with nobody who attends.

        Args:
            scripts: Of the page; the stick's joins them.
        """
        self._scripts = scripts
        self._steer: Steer | None = None

    def attend(self, steer: Steer) -> None:
        """Tell somebody how the stick is held.

        Args:
            steer: Takes the turn, from -1 (right) to 1 (left), and whether
                the robot shall walk.
        """
        self._steer = steer
        self._scripts.add(STICK)

    def answering(self, answer: Answer) -> Answer:
        """Answer the stick's requests, and leave others as they are."""

        def answered(
            connection: ServerConnection, request: Request
        ) -> Response | None:
            hears = self._steer and "Upgrade" not in request.headers
            if hears and urlsplit(request.path).path == "/hand":
                return self._hear(request)
            return answer(connection, request)

        return answered

    def _hear(self, request: Request) -> Response:
        """Steer as a request says, if it comes from a page of this place."""
        held = held_by(urlsplit(request.path).query)
        asks = request.headers.get_all(ASKS)
        if held is None or len(asks) != 1 or self._steer is None:
            return respond(b"", "text/plain", HTTPStatus.BAD_REQUEST)
        self._steer(*held)
        return respond(b"", "text/plain")


def held_by(query: str) -> tuple[float, bool] | None:
    """Turn, and whether to walk; None if the query does not say.

    Args:
        query: As in ``turn=0.5&going=1``.
    """
    try:
        said = parse_qs(query, strict_parsing=True, max_num_fields=2)
        [turn], [going] = said["turn"], said["going"]
        held = float(turn)
    except (KeyError, ValueError):
        return None
    if not isfinite(held) or abs(held) > 1.0 or going not in ("0", "1"):
        return None
    return held, going == "1"
