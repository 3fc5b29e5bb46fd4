"""Server of the ideal line of sight of a simulated robot."""

from ...perception.measurement import Measurement, Sighting
from .listener import ClientListener
from .lola_address import LolaAddress
from .sight_message import SightMessage, pack_sight


class SightOffer:
    """Server that sends the opponent's ideal sightings to one client."""

    def __init__(self, address: LolaAddress) -> None:
        """Listen.

        Raises:
            ConfigurationError: If the address cannot be listened on.
        """
        self._listener = ClientListener(address)
        self._sent: Sighting | None = None

    def send(self, measurement: Measurement, frame: int) -> None:
        """Send the sighting, if it is new or the client is.

        Args:
            measurement: Measurement of the robot at this tick.
            frame: Number of the sensor frame that will follow.
        """
        listener = self._listener
        if listener.accept():
            self._sent = None
        sighting = measurement.sighting
        if (
            sighting is None
            or sighting is self._sent
            or listener.client is None
        ):
            return
        age = max(measurement.time - sighting.time, 0.0)
        message = SightMessage(frame, age, sighting.bearing, sighting.distance)
        try:
            listener.send(pack_sight(message))
            self._sent = sighting
        except OSError as error:
            listener.drop(error)

    def restart(self) -> None:
        """Send the newest sighting again, as frame numbers start anew."""
        self._sent = None

    def close(self) -> None:
        """Stop the server."""
        self._listener.close()
