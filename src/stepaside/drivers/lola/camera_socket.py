"""Socket with the images of a simulated robot."""

import logging
import socket
from collections import deque
from dataclasses import replace

from ...perception.images import ColourImage, DepthImage, Percept
from ...perception.measurement import Measurement
from ..cameras.image_wire_format import (
    ImageError,
    ImageMessage,
    ImageReader,
    pack_image,
)
from ..guardian_process import SessionLost
from .listener import ClientListener
from .lola_address import LolaAddress

AHEAD = 8  # frames by which an image may come before its frame
CONNECT_TIMEOUT = 5.0  # in [s]
SEND_BUFFER = 1 << 22  # of the socket, in bytes
log = logging.getLogger(__name__)


class CameraClient:
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


class CameraServer:
    """Server that sends the images of a robot to one client.

    Images are dropped for a client that reads too slowly.

    Attributes:
        missed: Number of images that were dropped.
    """

    def __init__(self, address: LolaAddress) -> None:
        """Listen.

        Raises:
            ConfigurationError: If the address cannot be listened on.
        """
        self._listener = ClientListener(address)
        self._unsent = b""
        self._sent: Measurement | None = None
        self.missed = 0

    def send(self, measurement: Measurement, frame: int) -> None:
        """Send the images of a tick, each once.

        Args:
            measurement: Measurement of the robot at this tick.
            frame: Number of the sensor frame that will follow.
        """
        listener = self._listener
        if listener.accept():
            self._unsent, self._sent = b"", None
            assert listener.client is not None
            listener.client.setsockopt(
                socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER
            )
        self._send(b"")
        if measurement is self._sent or listener.client is None:
            return
        self._sent = measurement
        for percept in measurement.percepts:
            if not isinstance(percept, ColourImage | DepthImage):
                continue
            age = max(measurement.time - percept.time, 0.0)
            if self._unsent:
                self.missed += 1
                continue
            self._send(pack_image(ImageMessage(frame, age, percept)))

    def restart(self) -> None:
        """Send the newest images again, as frame numbers start anew."""
        self._sent = None

    def close(self) -> None:
        """Stop the server."""
        if self.missed:
            log.warning("%d images were not read in time", self.missed)
        self._listener.close()

    def _send(self, data: bytes) -> None:
        """Send queued and new data, as far as the client reads it."""
        listener = self._listener
        self._unsent += data
        while self._unsent and listener.client is not None:
            try:
                sent = listener.client.send(self._unsent)
            except (BlockingIOError, InterruptedError):
                return
            except OSError as error:
                listener.drop(error)
                self._unsent = b""
                return
            self._unsent = self._unsent[sent:]
