"""Additional scripts on viser's page.

viser has no way to add a script, so they are inserted into the head of the
page when it is served, and served by their own names.
"""

from collections.abc import Callable
from functools import cache
from http import HTTPStatus
from importlib.resources import files
from urllib.parse import urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

Answer = Callable[[ServerConnection, Request], Response | None]
HEAD = b"</title>"  # after which the scripts are inserted
PAGE = ("/", "/index.html")


class PageScripts:
    """Inserts scripts into a page and serves them."""

    def __init__(self, *names: str) -> None:
        """Start with some scripts.

        Args:
            names: Names of files beside this module.
        """
        self._names = list(names)

    def add(self, name: str) -> None:
        """Insert one more script from now on.

        Args:
            name: Name of a file beside this module.
        """
        if name not in self._names:
            self._names.append(name)

    def handle(self, answer: Answer) -> Answer:
        """Return a request handler that adds the scripts to a page.

        Args:
            answer: Handler of all other requests, and of the page, which it
                is asked for uncompressed.
        """

        def answered(
            connection: ServerConnection, request: Request
        ) -> Response | None:
            path = urlsplit(request.path).path
            if "Upgrade" in request.headers:
                return answer(connection, request)
            if path.removeprefix("/") in self._names:
                kind = "text/javascript; charset=utf-8"
                return respond(_script(path.removeprefix("/")), kind)
            if path not in PAGE:
                return answer(connection, request)
            headers = Headers(request.headers)
            if "Accept-Encoding" in headers:  # optional; del needs the key
                del headers["Accept-Encoding"]
            page = answer(connection, Request(request.path, headers))
            return page if page is None else self._insert_into(page)

        return answered

    def _insert_into(self, page: Response) -> Response:
        """Return the page with the scripts in its head."""
        tags = "".join(
            f'<script src="{name}" defer></script>' for name in self._names
        )
        return respond(
            bytes(page.body).replace(HEAD, HEAD + tags.encode(), 1),
            page.headers.get("Content-Type", "text/html; charset=utf-8"),
            HTTPStatus(page.status_code),
        )


@cache
def _script(name: str) -> bytes:
    return files(__package__).joinpath(name).read_bytes()


def respond(
    body: bytes, kind: str, status: HTTPStatus = HTTPStatus.OK
) -> Response:
    """Return a response that must not be cached.

    Args:
        body: Content.
        kind: Media type.
        status: HTTP status.
    """
    headers = Headers(
        {
            "Content-Type": kind,
            "Content-Length": str(len(body)),
            "Cache-Control": "no-store",
            "Connection": "close",
        }
    )
    return Response(status, status.phrase, headers, body)
