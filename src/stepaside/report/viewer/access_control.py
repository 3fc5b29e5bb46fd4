"""Who may come in: the door of the page's server."""

from collections.abc import Awaitable, Callable
from http import HTTPStatus
from secrets import compare_digest, token_urlsafe
from urllib.parse import urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from .page_address import PageAddress

CLIENTS = 16  # pages that are open at the same time
Handler = Callable[[ServerConnection], Awaitable[None]]
Answer = Callable[[ServerConnection, Request], Response | None]
HEADERS = {
    "Content-Security-Policy": "frame-ancestors 'none'; object-src 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}


class AccessControl:
    """Lets in who asks for this place from this place.

    A browser lets any page of the web ask any address, and says in ``Host``
    what was asked for and in ``Origin`` by whom. So the first must be a name
    of this place and the second the same; where other machines can ask, the
    link holds a secret, too.

    Attributes:
        address: Of the place.
        secret: First part of every path; empty on this machine alone.
        connected: Pages that are open.
    """

    def __init__(self, address: PageAddress) -> None:
        """Stand before an address."""
        self.address = address
        self.secret = "" if address.is_local else token_urlsafe(24)
        self.connected = 0

    @property
    def link(self) -> str:
        """What a browser is given."""
        return self.address.url + (f"/{self.secret}/" if self.secret else "")

    def refusal(self, request: Request) -> str:
        """Why somebody may not come in; empty if they may."""
        hosts = request.headers.get_all("Host")
        if len(hosts) != 1 or not self.address.answers_to(_name_of(hosts[0])):
            return "this place has another name"
        origins = request.headers.get_all("Origin")
        if origins and origins != [f"http://{hosts[0]}"]:
            return "only this page may ask"
        if _wants_socket(request) and not origins:
            return "say whence you ask"
        if self.secret and not self._knows(request.path):
            return "the link is not whole"
        return ""

    def _knows(self, path: str) -> bool:
        first = path.split("?")[0].split("/")[1:2]
        given = first[0] if first else ""
        return compare_digest(given.encode(), self.secret.encode())

    def guarded(self, answer: Answer) -> Answer:
        """Answer to requests, behind the door."""

        def checked(
            connection: ServerConnection, request: Request
        ) -> Response | None:
            why = self.refusal(request)
            if why:
                return _forbid(why)
            if self.secret:
                rest = request.path[len(self.secret) + 1 :]
                request = Request(rest or "/", request.headers)
            response = answer(connection, request)
            if response is not None:
                response.headers.update(HEADERS)
            return response

        return checked

    def counted(self, handler: Handler) -> Handler:
        """What serves an open page, for so many at a time."""

        async def handle(connection: ServerConnection) -> None:
            if self.connected >= CLIENTS:
                await connection.close(1013, f"{CLIENTS} pages are open")
                return
            self.connected += 1
            try:
                await handler(connection)
            finally:
                self.connected -= 1

        return handle


def _wants_socket(request: Request) -> bool:
    return any(
        "websocket" in each.lower()
        for each in request.headers.get_all("Upgrade")
    )


def _name_of(host: str) -> str:
    """Name in a ``Host`` header; empty if there is more in it than that."""
    try:
        parts = urlsplit(f"//{host}")
        _ = parts.port
    except ValueError:
        return ""
    only = parts.netloc == host and "@" not in host
    return (parts.hostname or "") if only else ""


def _forbid(why: str) -> Response:
    body = f"stepaside: {why}\n".encode()
    headers = Headers(
        {
            "Content-Type": "text/plain; charset=utf-8",
            "Content-Length": str(len(body)),
            "Connection": "close",
            **HEADERS,
        }
    )
    return Response(HTTPStatus.FORBIDDEN, "Forbidden", headers, body)
