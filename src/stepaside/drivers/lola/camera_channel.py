"""The client's end of a simulated robot's cameras."""

import logging
from collections import deque
from dataclasses import replace

from ...perception.images import Percept
from ..cameras.image_wire import ImageError, ImageMessage, ImageReader
from ..guardian_process import SessionLost
from .lola_address import LolaAddress

AHEAD = 8  # frames by which an image may come before its frame
CONNECTING = 5.0  # longest time to connect, in [s]
log = logging.getLogger(__name__)


class CameraChannel:
    """Hands over each image with the frame that it belongs to.

    A channel that breaks, or brings what is no image, is silent from then
    on, and the log says so.
    """

    def __init__(self, address: LolaAddress) -> None:
        """Connect.

        Raises:
            SessionLost: If nobody offers images there.
        """
        opened = address.open()
        opened.settimeout(CONNECTING)
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
        """Images that belong to a frame or to one before it.

        Args:
            frame: Number of the newest sensor frame.
            now: Its time, in [s].
            tick: Time from one frame to the next, in [s].
        """
        for message in self._receive():
            if message.frame > frame + AHEAD:
                log.warning("image from the future dropped at %d", frame)
                continue
            self._early.append(message)
        found: list[Percept] = []
        while self._early and self._early[0].frame <= frame:
            arrived, age, image = self._early.popleft()
            taken = now - (frame - arrived) * tick - age
            found.append(replace(image, time=taken))
        return found

    def close(self) -> None:
        """Stop looking."""
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
                log.warning("cameras lost: %s", error)
                self.close()
        return found
