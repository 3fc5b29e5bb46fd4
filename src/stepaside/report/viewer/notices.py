"""Messages over the scene, which take no room from anything and go away."""

from threading import Lock
from typing import Any

import viser

SHOWN = 8.0  # how long a message is seen, in [s]


class Notices:
    """Shows a message to all viewers of a page, one at a time."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Begin without a message.

        Args:
            server: Of the page.
        """
        self._server = server
        self._lock = Lock()
        self._open: dict[int, Any] = {}

    def say(self, text: str) -> None:
        """Replace the message that is shown, if there is one.

        Args:
            text: Plain text; empty to show none.
        """
        with self._lock:
            for notice in self._open.values():
                notice.remove()
            self._open = {}
            for number, client in self._server.get_clients().items():
                if text:
                    self._open[number] = client.add_notification(
                        "stepaside", text, auto_close_seconds=SHOWN
                    )
