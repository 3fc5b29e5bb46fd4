"""Server of the live page: viser's, on this machine alone."""

import logging
import threading
from typing import Any

import viser
import websockets.asyncio.server as sockets

from ...core.errors import ConfigurationError
from ..palette import rgb

HOST = "127.0.0.1"
STARTING = threading.Lock()
NOTICE_TIME = 8.0  # for which a message is shown, in [s]
BUTTONS = rgb("#143d7b")  # viser brightens it to the evader's blue
# Invalid requests must not print tracebacks on the terminal.
REQUEST_LOG = logging.getLogger(f"{__name__}.requests")
REQUEST_LOG.addFilter(lambda record: record.msg != "opening handshake failed")


def show_notice(server: viser.ViserServer, text: str) -> None:
    """Show a message over the scene to all viewers, for some seconds."""
    for client in server.get_clients().values():
        client.add_notification(
            "stepaside", text, auto_close_seconds=NOTICE_TIME
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
    begin, tried = sockets.serve, list[int]()

    def serve(handler: Any, host: str, port: int, **options: Any) -> Any:
        tried.append(port)
        own: Any = [f"http://{name}:{port}" for name in (HOST, "localhost")]
        return begin(
            handler, host, port, origins=own, logger=REQUEST_LOG, **options
        )

    with STARTING:
        sockets.serve = serve  # type: ignore[misc, assignment]
        try:
            server = viser.ViserServer(
                host=HOST, port=port, label="stepaside", verbose=False
            )
        finally:
            sockets.serve = begin  # type: ignore[misc]
    if not tried:
        server.stop()
        raise ConfigurationError(
            "viser must start a websockets server, so that origins can be "
            f"checked; version {viser.__version__} does not"
        )
    server.gui.configure_theme(
        show_logo=False, show_share_button=False, brand_color=BUTTONS
    )
    return server


def address_of(server: viser.ViserServer) -> str:
    """Return the URL of a page."""
    return f"http://{HOST}:{server.get_port()}"
