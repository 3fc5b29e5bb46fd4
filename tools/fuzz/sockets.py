"""A page's server, told what no page says."""

import atexit
import os
import socket
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import msgspec
import viser
from websockets.exceptions import InvalidHandshake, WebSocketException
from websockets.sync.client import connect

from stepaside.games.duel_settings import DuelSettings
from stepaside.report.viewer.live_page import Page

from .case import Case
from .values import NUMBERS, TEXTS, any_value

KINDS = (
    *("GuiUpdateMessage", "ViewerCameraMessage", "CommandTriggerMessage"),
    *("ShareUrlRequest", "FileTransferStartUpload", "Message", "", "__init__"),
)
NAMES = ("Host", "Origin", "Upgrade", "Content-Length", "X", "Cookie")


@cache
def page() -> Page:
    """Return a live page, shared by all cases."""
    made = Page(DuelSettings(), host="127.0.0.1", port=8611)
    made.start()
    atexit.register(made.close)
    return made


def socket_cases(random: Random, _: Path) -> Iterator[Case]:
    """Yield requests and messages without end, reproducible by seed."""
    while True:
        yield _case("request", random.getrandbits(32))
        yield _case("message", random.getrandbits(32))


def _case(name: str, seed: int) -> Case:
    def run(_: Path) -> str:
        draw = Random(seed)
        _ask(draw) if name == "request" else _tell(draw)
        return _still_right()

    return Case(f"hostile {name}s", f"{name} of seed {seed}", run, 60.0)


def _ask(draw: Random) -> None:
    """Send a malformed request."""
    lines = [
        f"{draw.choice(['GET', 'POST', 'PUT', '', 'G' * 9000])} "
        f"{draw.choice(['/', '//', '/../x', '*', '/' + 'a' * 9000, '%00'])} "
        f"{draw.choice(['HTTP/1.1', 'HTTP/9', 'X'])}"
    ]
    for _ in range(draw.choice([0, 1, 3, 200])):
        text = draw.choice([*TEXTS, *NUMBERS[:20], f"127.0.0.1:{port()}"])
        lines.append(f"{draw.choice(NAMES)}: {text}")
    raw = "\r\n".join([*lines, "", ""]).encode("utf-8", "surrogateescape")
    if draw.random() < 0.3:
        raw = draw.randbytes(draw.choice([1, 100, 100_000]))
    with socket.create_connection(("127.0.0.1", port()), 20) as sock:
        try:
            sock.sendall(raw)
            sock.shutdown(socket.SHUT_WR)
            while sock.recv(65536):
                pass
        except OSError:
            pass  # it hung up on us


def _tell(draw: Random) -> None:
    """Send malformed messages on an accepted socket."""
    try:
        with connect(
            f"ws://127.0.0.1:{port()}",
            origin=f"http://127.0.0.1:{port()}",  # type: ignore[arg-type]
            subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
            proxy=None,
        ) as connection:
            for _ in range(draw.choice([1, 5, 20])):
                connection.send(_message(draw))
    except (WebSocketException, InvalidHandshake, OSError):
        pass  # it hung up on us


def _message(draw: Random) -> bytes | str:
    if draw.random() < 0.2:
        return draw.randbytes(draw.choice([0, 1, 50, 70_000]))
    if draw.random() < 0.1:
        return draw.choice(["", "text", "{}", "a" * 70_000])
    controls = sorted(page().server.gui._gui_input_handle_from_uuid)
    values = draw.choice(["value", "label", "props", "_impl", "removed"])
    body: dict[str, Any] = {"type": draw.choice(KINDS)}
    if draw.random() < 0.8:
        body["uuid"] = draw.choice([*controls, *controls, "no", 1, None])
        body["updates"] = {values: _plain(draw)}
    else:
        names = ("fov", "near", "far", "wxyz", "position", "look_at")
        body |= {name: _plain(draw) for name in names}
    return msgspec.msgpack.encode(body)


def _plain(draw: Random) -> Any:
    while True:
        value = any_value(draw)
        try:
            msgspec.msgpack.encode(value)
        except (TypeError, OverflowError, ValueError):
            continue
        return value


def _still_right() -> str:
    """Return what is wrong with the page; empty if it still works."""
    session = page().session
    if session.error is not None:
        return f"stopped: {session.error}"
    if not page()._publisher.is_alive():
        return "the page is not refreshed any more"
    with socket.create_connection(("127.0.0.1", port()), 5) as sock:
        sock.sendall(
            f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port()}\r\n\r\n".encode()
        )
        answer = sock.recv(100)
    right = answer.startswith(b"HTTP/1.1 200")
    return "" if right else f"it answers {answer[:60]!r}"


def port() -> int:
    """Return the port of the page."""
    return page().server.get_port()


def memory() -> float:
    """Return the resident memory of this process, in [MB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6
