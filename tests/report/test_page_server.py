"""The live page is served to this machine and to its own pages only."""

import socket
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("viser", reason="viser is not installed")

from stepaside.report.viewer.page_server import (  # noqa: E402
    address_of,
    open_server,
)


@pytest.fixture(scope="module")
def server() -> Iterator[Any]:
    opened = open_server(8790)
    yield opened
    opened.stop()


def answer(server: Any, *headers: str) -> str:
    """Ask for a WebSocket; return the status line."""
    port = server.get_port()
    lines = [
        "GET / HTTP/1.1",
        f"Host: 127.0.0.1:{port}",
        "Upgrade: websocket",
        "Connection: Upgrade",
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Protocol: viser-v0",
        *headers,
    ]
    with socket.create_connection(("127.0.0.1", port), timeout=60) as link:
        link.sendall("\r\n".join([*lines, "", ""]).encode())
        return link.recv(4096).decode("latin-1").partition("\r\n")[0]


def test_only_pages_of_this_address_connect(server: Any) -> None:
    own, port = address_of(server), server.get_port()
    assert "101" in answer(server, f"Origin: {own}")
    assert "101" in answer(server, f"Origin: http://localhost:{port}")
    for origin in ("http://example.org", "null", f"http://evil.org:{port}"):
        assert "403" in answer(server, f"Origin: {origin}")
    assert "403" in answer(server)


def test_other_machines_cannot_connect(server: Any) -> None:
    with pytest.raises(OSError), socket.socket() as taken:
        taken.bind(("127.0.0.1", server.get_port()))
    with socket.socket() as outside:  # another address of this machine
        outside.bind(("127.0.0.2", server.get_port()))


def test_a_taken_port_is_passed_over(server: Any) -> None:
    other = open_server(server.get_port())
    try:
        assert other.get_port() > server.get_port()
    finally:
        other.stop()
