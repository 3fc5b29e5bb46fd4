"""The server's end of a simulated robot's cameras."""

import logging
import socket

from ...perception.images import ColourImage, DepthImage
from ...perception.measurement import Measurement
from ..cameras.image_wire import ImageMessage, pack_image
from ..joint.listener import ClientListener
from .lola_address import LolaAddress

ROOM = 1 << 22  # bytes that the system is asked to hold for a client
log = logging.getLogger(__name__)


class CameraOffer:
    """Shows whoever looks what the cameras of a robot see.

    Who reads too slowly misses images, and the game goes on.

    Attributes:
        missed: Images that were dropped.
    """

    def __init__(self, address: LolaAddress) -> None:
        """Listen.

        Raises:
            ConfigurationError: If the address cannot be listened on.
        """
        self._listener = ClientListener(address)
        self._left = b""
        self._told: Measurement | None = None
        self.missed = 0

    def tell(self, measurement: Measurement, frame: int) -> None:
        """Send the images that have arrived at a tick, each once.

        Args:
            measurement: What the robot's sensors give.
            frame: Number of the sensor frame that will follow.
        """
        listener = self._listener
        if listener.accept():
            self._left, self._told = b"", None
            assert listener.client is not None
            listener.client.setsockopt(
                socket.SOL_SOCKET, socket.SO_SNDBUF, ROOM
            )
        self._send(b"")
        if measurement is self._told or listener.client is None:
            return
        self._told = measurement
        for percept in measurement.percepts:
            if not isinstance(percept, ColourImage | DepthImage):
                continue
            age = max(measurement.time - percept.time, 0.0)
            if self._left:
                self.missed += 1
                continue
            self._send(pack_image(ImageMessage(frame, age, percept)))

    def forget(self) -> None:
        """Tell everything anew, as frames are numbered anew."""
        self._told = None

    def close(self) -> None:
        """Stop showing."""
        if self.missed:
            log.warning("%d images were not read in time", self.missed)
        self._listener.close()

    def _send(self, data: bytes) -> None:
        """Send what is left and what is new, as far as it is taken."""
        listener = self._listener
        self._left += data
        while self._left and listener.client is not None:
            try:
                sent = listener.client.send(self._left)
            except (BlockingIOError, InterruptedError):
                return
            except OSError as error:
                listener.drop(error)
                self._left = b""
                return
            self._left = self._left[sent:]
