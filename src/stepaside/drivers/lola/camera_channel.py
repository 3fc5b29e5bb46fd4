"""Client of a simulated robot's image channel."""

import logging
from collections import deque
from dataclasses import replace

from ...perception.images import Percept
from ..cameras.image_wire import ImageError, ImageMessage, ImageReader
from ..guardian_process import SessionLost
from .lola_address import LolaAddress

AHEAD = 8  # frames by which an image may come before its frame
CONNECT_TIMEOUT = 5.0  # in [s]
log = logging.getLogger(__name__)


class CameraChannel:
    """Image source that returns each image with its sensor frame.

    After a broken connection or an invalid message the channel logs a
    warning and returns no more images.
    """

    def __init__(self, address: LolaAddress) -> None:
        """Connect.

        Raises:
            SessionLost: If the address does not offer images.
        """
        opened = address.open()
        opened.settimeout(CONNECT_TIMEOUT)
        try:
            opened.connect(address.target)
        except OSError as error:
            opened.close()
            raise SessionLost(f"no camera at {address}: {error}") from error
        opened.setblocking(False)
        self._socket, self._is_open = opened, True
        self._reader = ImageReader()
        self._early: deque[ImageMessage] = deque()

    def percepts(self, frame: int, now: float, tick: float) -> list[Percept]:
        """Return the images that belong to a frame or an earlier one.

        Args:
            frame: Number of the newest sensor frame.
            now: Time of that frame, in [s].
            tick: Time from one frame to the next, in [s].
        """
        for message in self._receive():
            if message.frame > frame + AHEAD:
                log.warning(
                    "image of frame %d dropped at frame %d",
                    message.frame,
                    frame,
                )
                continue
            self._early.append(message)
        found: list[Percept] = []
        while self._early and self._early[0].frame <= frame:
            arrived, age, image = self._early.popleft()
            taken = now - (frame - arrived) * tick - age
            found.append(replace(image, time=taken))
        return found

    def close(self) -> None:
        """Disconnect."""
        if self._is_open:
            self._is_open = False
            self._socket.close()

    def _receive(self) -> list[ImageMessage]:
        found: list[ImageMessage] = []
        while self._is_open:
            try:
                data = self._socket.recv(1 << 18)
                if not data:
                    raise OSError("closed by the robot")
                found += self._reader.feed(data)
            except (BlockingIOError, InterruptedError):
                break
            except (OSError, ImageError) as error:
                log.warning("cameras disconnected: %s", error)
                self.close()
        return found
