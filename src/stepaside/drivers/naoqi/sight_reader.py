"""What a simulated robot tells beside the keys of NAOqi."""

import logging
from math import isfinite
from typing import Any

from ..guardian_process import SessionLost
from ..sighting_checks import fault_of

log = logging.getLogger(__name__)


def read_frame(told: Any) -> tuple[int, bool]:
    """Return the number of a frame, and whether its world waits.

    Raises:
        SessionLost: If it is none.
    """
    try:
        number, waits = (int(value) for value in told)
    except (TypeError, ValueError) as error:
        raise SessionLost(f"the robot's frame is {told!r:.60}") from error
    return number, bool(waits)


class SightReader:
    """Reads the ideal line of sight, and drops what cannot be one."""

    def __init__(self) -> None:
        """Begin with nothing dropped."""
        self._dropped = 0

    def read(self, told: Any) -> tuple[float, float, float] | None:
        """Return age [s], bearing [rad] and distance [m], if they can be.

        Args:
            told: What the robot tells; None if it sees nobody.

        Raises:
            SessionLost: If it is no sighting at all.
        """
        if told is None:
            return None
        try:
            age, bearing, distance = (float(value) for value in told)
        except (TypeError, ValueError) as error:
            raise SessionLost(f"the robot's sight is {told!r:.60}") from error
        fault = fault_of(bearing, distance)
        if not fault and isfinite(age):
            return age, bearing, distance
        self._dropped += 1
        if self._dropped.bit_count() == 1:  # 1, 2, 4, 8...
            log.warning("%d dropped: %s", self._dropped, fault or "no age")
        return None
