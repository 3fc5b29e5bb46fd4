"""Server of the pages: viser's, with access control and message filter.

viser starts a ``websockets`` server itself and offers no way to check
``Host`` and ``Origin``, to limit messages or to use a socket that listens
already; ``websockets`` does. So ``websockets.asyncio.server.serve`` is
replaced while viser starts. A version of viser that starts its server in
another way is refused.
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
from .page_layout import set_theme
from .page_messages import MAX_SIZE, MessageFilter
from .script_injection import Answer, PageScripts

STARTING = threading.Lock()
NOTICE_TIME = 8.0  # for which a message is shown, in [s]
ACCESSIBILITY_SCRIPT = "readable.js"
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


@dataclass(frozen=True, slots=True)
class PageServer:
    """Server of a page with its access control.

    Attributes:
        server: viser's server.
        gate: Access control.
        messages: Filter of the messages of pages.
        notices: Messages shown to viewers, such as refused input.
        joystick: Joystick and gamepad input.
    """

    server: viser.ViserServer
    gate: AccessControl
    messages: MessageFilter
    notices: Notices
    joystick: GamepadInput


def open_server(host: str, port: int) -> PageServer:
    """Serve an empty page.

    Args:
        host: Address of this machine.
        port: First port to try.

    Raises:
        ConfigurationError: If the address cannot be used.
    """
    address = listen(host, port)
    gate, messages = AccessControl(address), MessageFilter()
    scripts = PageScripts(ACCESSIBILITY_SCRIPT)
    joystick = GamepadInput(scripts)

    def handle(answer: Answer) -> Answer:
        return gate.guard(joystick.handle(scripts.handle(answer)))

    with STARTING, _controlled(address, gate, messages, handle) as started:
        server = viser.ViserServer(
            host=host, port=address.port, label="stepaside", verbose=False
        )
    if not started:
        server.stop()
        address.listening.close()
        raise ConfigurationError(
            "viser must start a websockets server, so that access can be "
            f"controlled; version {viser.__version__} does not"
        )
    notices = Notices(server)
    messages.watch(server.gui, server.scene, notices.show)
    set_theme(server.gui, "light")
    return PageServer(server, gate, messages, notices, joystick)


@contextmanager
def _controlled(
    address: PageAddress,
    gate: AccessControl,
    messages: MessageFilter,
    handle: Callable[[Answer], Answer],
) -> Iterator[list[bool]]:
    """Add access control to servers that start inside a ``with`` block.

    Yields:
        List with an entry for each server that was started.
    """
    begin, started = sockets.serve, []

    class FilteredConnection(sockets.ServerConnection):
        """Connection that drops messages a page could not have sent."""

        async def recv(self, decode: bool | None = None) -> Any:
            """Wait for the next accepted message."""
            while True:
                raw = await super().recv(decode)
                if messages.accepts(raw):
                    return raw

    def serve(handler: Any, *_: Any, **options: Any) -> Any:
        started.append(True)
        answer = options.pop("process_request")
        options |= {
            "process_request": handle(answer),
            "create_connection": FilteredConnection,
            "logger": REQUEST_LOG,
            "max_size": MAX_SIZE,
            "sock": address.listening,
        }
        return begin(gate.limit(handler), **options)

    sockets.serve = serve  # type: ignore[misc, assignment]
    try:
        yield started
    finally:
        sockets.serve = begin  # type: ignore[misc]
