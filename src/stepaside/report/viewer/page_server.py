"""The server of the pages: viser's, behind a door of our own.

viser starts the server of ``websockets`` itself and has no place for checks
of ``Host`` and ``Origin``, for bounds or for a socket that is open already.
``websockets`` has a place for each. So while viser starts, the function that
it starts its server with is ours, which adds them; a viser that starts
otherwise is not let serve.
"""

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import viser
import websockets.asyncio.server as sockets

from ...core.errors import ConfigurationError
from .access_control import AccessControl
from .gamepad import GamepadInput
from .page_address import PageAddress, listen
from .page_layout import dress
from .page_messages import LARGEST, MessageFilter
from .page_scripts import Answer, PageScripts

STARTING = threading.Lock()
READABLE = "readable.js"  # names, headings and contrast for those who need it
# Whoever knocks with what is no request leaves no traceback on our terminal.
QUIET = logging.getLogger(f"{__name__}.requests")
QUIET.addFilter(lambda record: record.msg != "opening handshake failed")


@dataclass(frozen=True, slots=True)
class PageServer:
    """A page's server and its door.

    Attributes:
        server: The server.
        gate: Who may come in.
        listener: What they may say.
        hand: Hears the stick.
    """

    server: viser.ViserServer
    gate: AccessControl
    listener: MessageFilter
    hand: GamepadInput


def open_server(host: str, port: int) -> PageServer:
    """Serve an empty page.

    Args:
        host: Address of this machine.
        port: First port to try.

    Raises:
        ConfigurationError: If nothing can be served there.
    """
    address = listen(host, port)
    gate, listener = AccessControl(address), MessageFilter()
    scripts = PageScripts(READABLE)
    hand = GamepadInput(scripts)

    def ours(answer: Answer) -> Answer:
        return gate.guarded(hand.answering(scripts.answering(answer)))

    with STARTING, _behind(address, gate, listener, ours) as started:
        server = viser.ViserServer(
            host=host, port=address.port, label="stepaside", verbose=False
        )
    if not started:
        server.stop()
        address.listening.close()
        raise ConfigurationError(
            f"viser must be one that starts a server of websockets; "
            f"{viser.__version__} does not, and would be open to all"
        )
    listener.attend(server.gui, server.scene)
    dress(server.gui, "light")
    return PageServer(server, gate, listener, hand)


@contextmanager
def _behind(
    address: PageAddress,
    gate: AccessControl,
    listener: MessageFilter,
    ours: Callable[[Answer], Answer],
) -> Iterator[list[bool]]:
    """Let servers that start meanwhile start behind a door."""
    begin, started = sockets.serve, []

    class FilteredConnection(sockets.ServerConnection):
        """A connection on which only what may be said is heard."""

        async def recv(self, decode: bool | None = None) -> Any:
            """Wait for the next message that is heard."""
            while True:
                raw = await super().recv(decode)
                if listener.hears(raw):
                    return raw

    def serve(handler: Any, *_: Any, **options: Any) -> Any:
        started.append(True)
        answer = options.pop("process_request")
        options |= {
            "process_request": ours(answer),
            "create_connection": FilteredConnection,
            "logger": QUIET,
            "max_size": LARGEST,
            "sock": address.listening,
        }
        return begin(gate.counted(handler), **options)

    sockets.serve = serve  # type: ignore[misc, assignment]
    try:
        yield started
    finally:
        sockets.serve = begin  # type: ignore[misc]
