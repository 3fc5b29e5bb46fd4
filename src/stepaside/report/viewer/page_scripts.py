"""Scripts of our own on a page of viser's, which has no place for them.

They are put into the page at the door: whoever asks for the page gets it with
them in its head, and then asks for each by its name.
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
HEAD = b"</title>"  # after which the scripts are put
PAGE = ("/", "/index.html")


class PageScripts:
    """Puts scripts into a page, and answers who asks for them."""

    def __init__(self, *names: str) -> None:
        """Begin with some.

        Args:
            names: Of files beside this one.
        """
        self._names = list(names)

    def add(self, name: str) -> None:
        """Put one more into the page from now on."""
        if name not in self._names:
            self._names.append(name)

    def answering(self, answer: Answer) -> Answer:
        """Answer for the page and its scripts, and leave others as they are.

        Args:
            answer: What the page is served by; it is asked for the page as
                it is, not compressed.
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
            if "Accept-Encoding" in headers:  # not everybody sends it
                del headers["Accept-Encoding"]
            page = answer(connection, Request(request.path, headers))
            return page if page is None else self._put_into(page)

        return answered

    def _put_into(self, page: Response) -> Response:
        """The page with the scripts in its head."""
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
    """An answer that nobody keeps.

    Args:
        body: What it says.
        kind: Its media type.
        status: Of HTTP.
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
