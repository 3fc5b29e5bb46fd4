"""Server of a simulated robot's image channel."""

import logging
import socket

from ...perception.images import ColourImage, DepthImage
from ...perception.measurement import Measurement
from ..cameras.image_wire import ImageMessage, pack_image
from .listener import ClientListener
from .lola_address import LolaAddress

SEND_BUFFER = 1 << 22  # of the socket, in bytes
log = logging.getLogger(__name__)


class CameraOffer:
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
