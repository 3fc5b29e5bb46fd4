"""Decoders of a simulated robot's additional keys in ALMemory."""

import logging
from math import isfinite
from typing import Any

from ..guardian_process import SessionLost
from ..sighting_checks import sighting_fault

log = logging.getLogger(__name__)


def read_frame(value: Any) -> tuple[int, bool]:
    """Return the number of a frame, and whether it is of lock step.

    Raises:
        SessionLost: If the value is invalid.
    """
    try:
        number, waits = (int(entry) for entry in value)
    except (TypeError, ValueError) as error:
        raise SessionLost(
            f"the robot's frame must be two numbers, got {value!r:.60}"
        ) from error
    return number, bool(waits)


class SightReader:
    """Decoder of the ideal line of sight, which drops invalid sightings."""

    def __init__(self) -> None:
        """Start with no dropped sighting."""
        self._dropped = 0

    def read(self, value: Any) -> tuple[float, float, float] | None:
        """Return age [s], bearing [rad] and distance [m]; None if invalid.

        Args:
            value: Value of the key; None without a sighting.

        Raises:
            SessionLost: If the value is not three numbers.
        """
        if value is None:
            return None
        try:
            age, bearing, distance = (float(entry) for entry in value)
        except (TypeError, ValueError) as error:
            raise SessionLost(
                "the robot's sighting must be three numbers, got "
                f"{value!r:.60}"
            ) from error
        fault = sighting_fault(bearing, distance)
        if not fault and isfinite(age):
            return age, bearing, distance
        self._dropped += 1
        if self._dropped.bit_count() == 1:  # 1, 2, 4, 8...
            log.warning(
                "%d sightings dropped: %s",
                self._dropped,
                fault or f"age must be finite, got {age}",
            )
        return None
