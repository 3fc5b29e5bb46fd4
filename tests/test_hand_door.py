"""The page comes to whoever asks for it, with the stick's script."""

from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("websockets")

from http import HTTPStatus

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from stepaside.report.viewer.hand import SCRIPT, Hand


@pytest.mark.parametrize("sent", [{}, {"Accept-Encoding": "gzip"}])
def test_the_page_comes_whatever_encodings_are_accepted(
    sent: dict[str, str],
) -> None:
    asked: list[Request] = []

    def answer(_: Any, request: Request) -> Response:
        asked.append(request)
        return Response(HTTPStatus.OK, "OK", Headers(), b"<title>x</title>")

    hand = Hand()
    hand.attend(lambda *_: None)
    connection: Any = SimpleNamespace()
    page = hand.answering(answer)(connection, Request("/", Headers(sent)))
    assert page is not None and SCRIPT in bytes(page.body)
    assert "Accept-Encoding" not in asked[0].headers
