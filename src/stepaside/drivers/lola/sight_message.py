"""Wire format of the ideal line of sight of a simulated robot.

One little-endian message of 32 bytes for each new sighting: the letters
``SGHT``, the number of the sensor frame with which it arrived (uint32), its
age in [s], the bearing in [rad] and the distance in [m] (float64 each).
"""

import struct
from typing import NamedTuple

from ...core.errors import StepAsideError
from ..sighting_checks import sighting_fault

MESSAGE = struct.Struct("<4sIddd")
LETTERS = b"SGHT"
MAX_AGE = 10.0  # age of a sighting that is accepted, in [s]


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
