"""A stick and a gamepad for the live page, which viser itself lacks.

viser's page has no place for a script of ours, and no control that says how
far something is held to one side. So its page gets one more script at the
door; that draws a stick where fingers point, reads a gamepad, and tells how
both are held in requests of its own.
"""

from collections.abc import Callable
from functools import cache
from http import HTTPStatus
from importlib.resources import files
from math import isfinite
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

Answer = Callable[[ServerConnection, Request], Response | None]
Steer = Callable[[float, bool], None]
ASKS = "X-Stepaside"  # a header that only a page of this place can send
HEAD = b"</title>"  # after which the script is put
SCRIPT = b'</title><script src="stick.js" defer></script>'


class Hand:
    """Answers the stick of a page, once somebody attends to it."""

    def __init__(self) -> None:
        """Begin with nobody who attends."""
        self._steer: Steer | None = None

    def attend(self, steer: Steer) -> None:
        """Tell somebody how the stick is held.

        Args:
            steer: Takes the turn, from -1 (right) to 1 (left), and whether
                the robot shall walk.
        """
        self._steer = steer

    def answering(self, answer: Answer) -> Answer:
        """Answer the stick's requests, and leave others as they are."""

        def answered(
            connection: ServerConnection, request: Request
        ) -> Response | None:
            path = urlsplit(request.path).path
            if self._steer is None or "Upgrade" in request.headers:
                return answer(connection, request)
            if path == "/stick.js":
                return _respond(_script(), "text/javascript; charset=utf-8")
            if path == "/hand":
                return self._hear(request)
            if path not in ("/", "/index.html"):
                return answer(connection, request)
            headers = Headers(request.headers)
            if "Accept-Encoding" in headers:  # not everybody sends it
                del headers["Accept-Encoding"]
            page = answer(connection, Request(request.path, headers))
            return page if page is None else _with_script(page)

        return answered

    def _hear(self, request: Request) -> Response:
        """Steer as a request says, if it comes from a page of this place."""
        held = held_by(urlsplit(request.path).query)
        asks = request.headers.get_all(ASKS)
        if held is None or len(asks) != 1 or self._steer is None:
            return _respond(b"", "text/plain", HTTPStatus.BAD_REQUEST)
        self._steer(*held)
        return _respond(b"", "text/plain")


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


@cache
def _script() -> bytes:
    return files(__package__).joinpath("stick.js").read_bytes()


def _with_script(page: Response) -> Response:
    """The page with the stick's script in its head."""
    return _respond(
        bytes(page.body).replace(HEAD, SCRIPT, 1),
        page.headers.get("Content-Type", "text/html; charset=utf-8"),
        HTTPStatus(page.status_code),
    )


def _respond(
    body: bytes, kind: str, status: HTTPStatus = HTTPStatus.OK
) -> Response:
    headers = Headers(
        {
            "Content-Type": kind,
            "Content-Length": str(len(body)),
            "Cache-Control": "no-store",
            "Connection": "close",
        }
    )
    return Response(status, status.phrase, headers, body)
