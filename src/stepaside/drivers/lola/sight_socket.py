"""Socket with the ideal line of sight of a simulated robot.

One little-endian message of 32 bytes for each new sighting: the letters
``SGHT``, the number of the sensor frame with which it arrived (uint32), its
age in [s], the bearing in [rad] and the distance in [m] (float64 each).
"""

import logging
import struct
from collections import deque
from typing import NamedTuple

from ...core.errors import StepAsideError
from ...perception.measurement import Measurement, Sighting
from ..guardian_process import SessionLost
from ..joint.link import FrameLink
from ..sighting_checks import sighting_fault
from .listener import ClientListener
from .lola_address import LolaAddress
from .nao_joints import TICK

MESSAGE = struct.Struct("<4sIddd")
LETTERS = b"SGHT"
MAX_AGE = 10.0  # age of a sighting that is accepted, in [s]
AHEAD = 8  # frames by which a sighting may come before its frame: 0.1 s
log = logging.getLogger(__name__)


class SightError(StepAsideError, ValueError):
    """Bytes that are not a valid sighting."""


class SightMessage(NamedTuple):
    """Sighting with the sensor frame that it belongs to.

    Attributes:
        frame: Number of the sensor frame with which it arrived.
        age: Time from the sighting to that frame, in [s].
        bearing: Direction of the opponent from the torso's heading, in
            [rad].
        distance: Distance of the opponent, in [m].
    """

    frame: int
    age: float
    bearing: float
    distance: float


def pack_sight(message: SightMessage) -> bytes:
    """Encode a message."""
    return MESSAGE.pack(LETTERS, *message)


def unpack_sight(data: bytes) -> SightMessage:
    """Decode a message.

    Raises:
        SightError: If length, letters or values are invalid.
    """
    if len(data) != MESSAGE.size:
        raise SightError(
            f"a sighting must have {MESSAGE.size} bytes, got {len(data)}"
        )
    letters, frame, age, bearing, distance = MESSAGE.unpack(data)
    if letters != LETTERS:
        raise SightError(f"a sighting must begin with {LETTERS!r}")
    if not 0.0 <= age <= MAX_AGE:
        raise SightError(
            f"the age of the sighting must lie in [0, {MAX_AGE:g}] s, "
            f"got {age:g} s"
        )
    if fault := sighting_fault(bearing, distance):
        raise SightError(fault)
    return SightMessage(frame, age, bearing, distance)


class SightClient:
    """Reader that returns each sighting with its sensor frame."""

    def __init__(self, link: FrameLink) -> None:
        """Read from a link of messages."""
        self._link: FrameLink | None = link
        self._early: deque[SightMessage] = deque()
        self._newest: SightMessage | None = None
        self._last = -1

    def newest(self, frame: int, start: int) -> Sighting | None:
        """Return the newest sighting of a frame or an earlier one.

        Invalid messages, and those of later frames or out of order, are
        dropped with a warning. After a broken connection no new sighting is
        returned.

        Args:
            frame: Number of the newest sensor frame.
            start: Number of the frame at which time is zero.
        """
        for data in self._receive():
            try:
                message = unpack_sight(data)
            except SightError as error:
                log.warning("sighting dropped: %s", error)
                continue
            if message.frame < self._last or message.frame > frame + AHEAD:
                log.warning(
                    "sighting of frame %d dropped at frame %d",
                    message.frame,
                    frame,
                )
                continue
            self._last = message.frame
            self._early.append(message)
        while self._early and self._early[0].frame <= frame:
            self._newest = self._early.popleft()
        if self._newest is None:
            return None
        number, age, bearing, distance = self._newest
        return Sighting((number - start) * TICK - age, bearing, distance)

    def close(self) -> None:
        """Disconnect."""
        if self._link is not None:
            self._link.close()
            self._link = None

    def _receive(self) -> list[bytes]:
        if self._link is None:
            return []
        try:
            return self._link.receive()
        except SessionLost as error:
            log.warning("ideal line of sight disconnected: %s", error)
            self.close()
            return []


class SightServer:
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
