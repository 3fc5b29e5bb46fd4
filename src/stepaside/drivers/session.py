"""What every way to a robot has in common."""

import logging
from collections.abc import Callable
from time import monotonic, sleep
from typing import TypeVar

from ..errors import StepAsideError

log = logging.getLogger(__name__)

Opened = TypeVar("Opened")
PAUSE = 0.1  # between two tries to connect, in [s]


class SessionLost(StepAsideError, ConnectionError):
    """The robot cannot be heard or reached any more."""


def open_within(open_robot: Callable[[], Opened], patience: float) -> Opened:
    """Connect to a robot that may not be there yet.

    Args:
        open_robot: Connects, or raises SessionLost.
        patience: How long to try again, in [s]; 0 tries once.

    Raises:
        SessionLost: If the last try fails.
    """
    until, said = monotonic() + patience, False
    while True:
        try:
            return open_robot()
        except SessionLost as error:
            if monotonic() >= until:
                raise
            if not said:
                log.info("%s; waits up to %g s for it", error, patience)
                said = True
            sleep(PAUSE)
