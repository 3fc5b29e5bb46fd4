"""The stick at the door of a live page."""

from collections.abc import Iterator
from http.client import HTTPConnection

import pytest

pytest.importorskip("viser")

from stepaside.report.viewer.gamepad import parse_position  # noqa: E402
from stepaside.report.viewer.page_server import PageServer, open_server  # noqa: E402

Held = list[tuple[float, bool]]


@pytest.fixture(scope="module")
def served() -> Iterator[PageServer]:
    opened = open_server("127.0.0.1", 8990)
    yield opened
    opened.server.stop()


def ask(served: PageServer, path: str, **headers: str) -> tuple[int, str]:
    """Status and text of an answer."""
    link = HTTPConnection("127.0.0.1", served.gate.address.port, timeout=60)
    link.request("GET", path, headers=headers)
    answer = link.getresponse()
    text = answer.read().decode("utf-8")
    link.close()
    return answer.status, text


@pytest.mark.parametrize(
    ("query", "held"),
    [
        ("turn=0.25&going=1", (0.25, True)),
        ("going=0&turn=-1", (-1.0, False)),
        ("turn=1.01&going=1", None),
        ("turn=nan&going=1", None),
        ("turn=inf&going=0", None),
        ("turn=left&going=1", None),
        ("turn=0&going=yes", None),
        ("turn=0&turn=1&going=1", None),
        ("turn=0&going=1&more=1", None),
        ("turn=0", None),
        ("", None),
    ],
)
def test_only_a_stick_that_can_be_held_so_is_heard(
    query: str, held: tuple[float, bool] | None
) -> None:
    assert parse_position(query) == held


def test_a_stick_is_on_the_page_that_attends_and_tells_how_it_is_held(
    served: PageServer,
) -> None:
    assert "stick.js" not in ask(served, "/")[1]
    assert ask(served, "/hand?turn=0&going=1")[0] == 404
    held: Held = []
    served.joystick.connect(lambda turn, going: held.append((turn, going)))
    status, page = ask(served, "/")
    assert status == 200 and page.count('<script src="stick.js"') == 1
    status, script = ask(served, "/stick.js")
    assert status == 200 and "getGamepads" in script
    asked = "/hand?turn=-0.5&going=1"
    assert ask(served, asked, **{"X-Stepaside": "hand"})[0] == 200
    assert held == [(-0.5, True)]


def test_pages_of_elsewhere_hold_no_stick(served: PageServer) -> None:
    """An image or a form elsewhere sends no header of ours; nor a script."""
    held: Held = []
    served.joystick.connect(lambda turn, going: held.append((turn, going)))
    asked = "/hand?turn=1&going=1"
    assert ask(served, asked)[0] == 400
    elsewhere = {"X-Stepaside": "hand", "Origin": "http://evil.example"}
    assert ask(served, asked, **elsewhere)[0] == 403
    assert held == []
