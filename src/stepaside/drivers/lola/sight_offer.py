"""The server's end of the ideal line of sight."""

from ...perception.measurement import Measurement, Sighting
from ..joint.listener import ClientListener
from .lola_address import LolaAddress
from .sight_message import SightMessage, pack_sight


class SightOffer:
    """Tells whoever listens where the other robot is."""

    def __init__(self, address: LolaAddress) -> None:
        """Listen.

        Raises:
            ConfigurationError: If the address cannot be listened on.
        """
        self._listener = ClientListener(address)
        self._told: Sighting | None = None

    def tell(self, measurement: Measurement, frame: int) -> None:
        """Send a sighting that is new, or new to a client.

        Args:
            measurement: What the robot's sensors give.
            frame: Number of the sensor frame that will follow.
        """
        listener = self._listener
        if listener.accept():
            self._told = None
        seen = measurement.sighting
        if seen is None or seen is self._told or listener.client is None:
            return
        age = max(measurement.time - seen.time, 0.0)
        message = SightMessage(frame, age, seen.bearing, seen.distance)
        try:
            listener.send(pack_sight(message))
            self._told = seen
        except OSError as error:
            listener.drop(error)

    def forget(self) -> None:
        """Tell everything anew, as frames are numbered anew."""
        self._told = None

    def close(self) -> None:
        """Stop telling."""
        self._listener.close()
