"""The ideal line of sight beside a simulated robot's socket.

One message of 32 bytes for each new sighting, little-endian: the letters
``SGHT``, the number of the sensor frame with which it arrived (uint32), its
age in [s], the bearing in [rad] and the distance in [m] (float64 each). It
is the simulator's truth, and its channel is named for what it is.
"""

import struct
from typing import NamedTuple

from ...core.errors import StepAsideError
from ..sighting_checks import fault_of

MESSAGE = struct.Struct("<4sIddd")
LETTERS = b"SGHT"
OLDEST = 10.0  # age beyond which a sighting says nothing, in [s]


class SightError(StepAsideError, ValueError):
    """Bytes that are no sighting."""


class SightMessage(NamedTuple):
    """One sighting on its way.

    Attributes:
        frame: Number of the sensor frame with which it arrived.
        age: How long before that frame it was taken, in [s].
        bearing: Direction of the other from the torso's heading, in [rad].
        distance: To the other, in [m].
    """

    frame: int
    age: float
    bearing: float
    distance: float


def pack_sight(message: SightMessage) -> bytes:
    """Bytes of a message."""
    return MESSAGE.pack(LETTERS, *message)


def unpack_sight(data: bytes) -> SightMessage:
    """Read a message.

    Raises:
        SightError: If the bytes are anything else, or say what cannot be.
    """
    if len(data) != MESSAGE.size:
        raise SightError(
            f"a sighting must have {MESSAGE.size} bytes, got {len(data)}"
        )
    letters, frame, age, bearing, distance = MESSAGE.unpack(data)
    if letters != LETTERS:
        raise SightError(f"a sighting must begin with {LETTERS!r}")
    if not 0.0 <= age <= OLDEST:
        raise SightError(
            f"the age of the sighting must lie in [0, {OLDEST:g}] s, "
            f"got {age:g} s"
        )
    if fault := fault_of(bearing, distance):
        raise SightError(fault)
    return SightMessage(frame, age, bearing, distance)
