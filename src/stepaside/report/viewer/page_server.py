"""Server of the live page: viser's, on this machine alone."""

import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import viser
import websockets.asyncio.server as sockets

from ...core.errors import ConfigurationError
from ..palette import PALETTES, rgb

HOST = "127.0.0.1"
STARTING = threading.Lock()
NOTICE_TIME = 8.0  # for which a message is shown, in [s]
# viser brightens the colour of buttons in the light theme: this one becomes
# the evader's blue, with enough contrast to white text.
BUTTON_COLOURS = {"light": "#143d7b", "dark": PALETTES["light"].evader}
# Invalid requests must not print tracebacks on the terminal.
REQUEST_LOG = logging.getLogger(f"{__name__}.requests")
REQUEST_LOG.addFilter(lambda record: record.msg != "opening handshake failed")


class Notices:
    """Messages over the scene, one at a time, shown to all viewers."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Start without a message.

        Args:
            server: Server of the page.
        """
        self._server = server
        self._lock = threading.Lock()
        self._open: list[Any] = []

    def show(self, text: str) -> None:
        """Replace the message that is shown.

        Args:
            text: Plain text; empty to show none.
        """
        with self._lock:
            for notice in self._open:
                notice.remove()
            self._open = []
            if not text:
                return
            for client in self._server.get_clients().values():
                notice = client.add_notification(
                    "stepaside", text, auto_close_seconds=NOTICE_TIME
                )
                self._open.append(notice)


def set_theme(gui: viser.GuiApi, theme: str) -> None:
    """Set the theme of a page, or of the page of one viewer.

    Args:
        gui: Controls of all viewers or of one.
        theme: One of :data:`~stepaside.report.palette.THEMES`.
    """
    gui.configure_theme(
        dark_mode=theme == "dark",
        show_logo=False,
        show_share_button=False,
        brand_color=rgb(BUTTON_COLOURS[theme]),
    )


def open_server(port: int) -> viser.ViserServer:
    """Serve an empty page on this machine, at the next free port.

    Pages of other origins cannot connect: a browser lets any page open a
    WebSocket to any address, and says in ``Origin`` where the page is from.

    Args:
        port: First port to try.

    Raises:
        ConfigurationError: If origins cannot be checked with this viser.
    """
    with STARTING, _origins_checked() as started:
        server = viser.ViserServer(
            host=HOST, port=port, label="stepaside", verbose=False
        )
    if not started:
        server.stop()
        raise ConfigurationError(
            "viser must start a websockets server, so that origins can be "
            f"checked; version {viser.__version__} does not"
        )
    set_theme(server.gui, "light")
    return server


def address_of(server: viser.ViserServer) -> str:
    """Return the URL of a page."""
    return f"http://{HOST}:{server.get_port()}"


@contextmanager
def _origins_checked() -> Iterator[list[int]]:
    """Let servers that start in a ``with`` block accept their own pages only.

    Yields:
        List that gets the ports that were tried.
    """
    begin, started = sockets.serve, []

    def serve(handler: Any, host: str, port: int, **options: Any) -> Any:
        started.append(port)
        own: Any = [f"http://{name}:{port}" for name in (HOST, "localhost")]
        return begin(
            handler, host, port, origins=own, logger=REQUEST_LOG, **options
        )

    sockets.serve = serve  # type: ignore[misc, assignment]
    try:
        yield started
    finally:
        sockets.serve = begin  # type: ignore[misc]
