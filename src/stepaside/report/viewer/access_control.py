"""Access control of the page's server: Host, Origin, secret, connections."""

from collections.abc import Awaitable, Callable
from http import HTTPStatus
from secrets import compare_digest, token_urlsafe
from urllib.parse import urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from .page_address import PageAddress

MAX_CLIENTS = 16  # pages that may be open at the same time
Handler = Callable[[ServerConnection], Awaitable[None]]
Answer = Callable[[ServerConnection, Request], Response | None]
HEADERS = {
    "Content-Security-Policy": "frame-ancestors 'none'; object-src 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}


class AccessControl:
    """Accepts requests to an address only from the pages served there.

    A browser lets any web page send requests to any address; it reports the
    requested name in ``Host`` and the origin of the page in ``Origin``. So
    ``Host`` must be a name of this address and ``Origin`` must equal it. If
    other machines can connect, each path must begin with a secret, too.

    Attributes:
        address: The address.
        secret: First part of every path; empty for a loopback address.
        connected: Number of open pages.
    """

    def __init__(self, address: PageAddress) -> None:
        """Control an address."""
        self.address = address
        self.secret = "" if address.is_local else token_urlsafe(24)
        self.connected = 0

    @property
    def link(self) -> str:
        """URL to open, including the secret."""
        return self.address.url + (f"/{self.secret}/" if self.secret else "")

    def refusal(self, request: Request) -> str:
        """Return why a request is refused; empty if it is accepted."""
        hosts = request.headers.get_all("Host")
        if len(hosts) != 1 or not self.address.answers_to(_name_of(hosts[0])):
            return "unexpected Host header"
        origins = request.headers.get_all("Origin")
        if origins and origins != [f"http://{hosts[0]}"]:
            return "unexpected Origin header"
        if _is_websocket(request) and not origins:
            return "missing Origin header"
        if self.secret and not self._has_secret(request.path):
            return "the path must begin with the secret of the link"
        return ""

    def _has_secret(self, path: str) -> bool:
        first = path.split("?")[0].split("/")[1:2]
        given = first[0] if first else ""
        return compare_digest(given.encode(), self.secret.encode())

    def guard(self, answer: Answer) -> Answer:
        """Return a request handler that refuses unauthorised requests.

        Args:
            answer: Handler of authorised requests.
        """

        def checked(
            connection: ServerConnection, request: Request
        ) -> Response | None:
            reason = self.refusal(request)
            if reason:
                return _forbid(reason)
            if self.secret:
                rest = request.path[len(self.secret) + 1 :]
                request = Request(rest or "/", request.headers)
            response = answer(connection, request)
            if response is not None:
                response.headers.update(HEADERS)
            return response

        return checked

    def limit(self, handler: Handler) -> Handler:
        """Return a connection handler that limits the number of open pages.

        Args:
            handler: Handler of one connection.
        """

        async def handle(connection: ServerConnection) -> None:
            if self.connected >= MAX_CLIENTS:
                reason = f"{MAX_CLIENTS} pages are open already"
                await connection.close(1013, reason)
                return
            self.connected += 1
            try:
                await handler(connection)
            finally:
                self.connected -= 1

        return handle


def _is_websocket(request: Request) -> bool:
    return any(
        "websocket" in each.lower()
        for each in request.headers.get_all("Upgrade")
    )


def _name_of(host: str) -> str:
    """Return the name in a ``Host`` header; empty if it is malformed."""
    try:
        parts = urlsplit(f"//{host}")
        _ = parts.port
    except ValueError:
        return ""
    well_formed = parts.netloc == host and "@" not in host
    return (parts.hostname or "") if well_formed else ""


def _forbid(reason: str) -> Response:
    body = f"stepaside: {reason}\n".encode()
    headers = Headers(
        {
            "Content-Type": "text/plain; charset=utf-8",
            "Content-Length": str(len(body)),
            "Connection": "close",
            **HEADERS,
        }
    )
    return Response(HTTPStatus.FORBIDDEN, "Forbidden", headers, body)
