"""The page reaches each client with our scripts."""

from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("websockets")

from http import HTTPStatus

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from stepaside.report.viewer.script_injection import PageScripts


@pytest.mark.parametrize("sent", [{}, {"Accept-Encoding": "gzip"}])
def test_the_page_comes_whatever_encodings_are_accepted(
    sent: dict[str, str],
) -> None:
    asked: list[Request] = []

    def answer(_: Any, request: Request) -> Response:
        asked.append(request)
        return Response(HTTPStatus.OK, "OK", Headers(), b"<title>x</title>")

    scripts = PageScripts("stick.js")
    scripts.add("stick.js")
    connection: Any = SimpleNamespace()
    page = scripts.handle(answer)(connection, Request("/", Headers(sent)))
    assert page is not None
    assert bytes(page.body).count(b'<script src="stick.js" defer>') == 1
    assert "Accept-Encoding" not in asked[0].headers
