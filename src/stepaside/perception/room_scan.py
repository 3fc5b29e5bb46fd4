"""Scan of the room before a game, to fill the map of the floor."""

from math import copysign

from ..core.poses import wrap_angle
from .gaze import Gaze

SCAN_ENDS = 2
RIGHT = -1.0  # the body turns away from the first side of the scan
# Turn of the body that brings the floor behind into view: the head yaws 115
# degrees to either side, and its camera sees 29 degrees more, in [rad].
BODY_TURN = 1.3
HEADING_TOLERANCE = 0.15  # of the turn back to the first heading, in [rad]
MAX_DURATION = 10.0  # of a scan, in [s]


class NoScan:
    """Absence of a scan: a game begins at once.

    Attributes:
        turning: 0: the body does not turn.
    """

    turning = 0.0

    def lasts(self, gaze: Gaze) -> bool:
        """Return false."""
        return False

    def look(self, gaze: Gaze, now: float, heading: float) -> None:
        """Search for the opponent."""
        gaze.search()


class RoomScan:
    """Scan of the head to both sides, and optionally behind the body.

    A robot that walks backward also turns on the spot, away from the first
    side of the scan, and holds the head at the second end until the floor
    behind is visible or half of the time has passed. It then turns back to
    its first heading, from which the game begins.

    Attributes:
        turning: Requested turn on the spot: 1 left, -1 right, 0 none.
    """

    def __init__(self, *, behind: bool) -> None:
        """Start a scan that has not begun.

        Args:
            behind: Whether to turn the body and scan behind.
        """
        self._behind = behind
        self.turning = 0.0
        self._start: tuple[float, float] | None = None

    def lasts(self, gaze: Gaze) -> bool:
        """Return whether the scan is incomplete."""
        return gaze.scan_ends < SCAN_ENDS or self.turning != 0.0

    def look(self, gaze: Gaze, now: float, heading: float) -> None:
        """Advance the scan by one tick.

        Args:
            gaze: Gaze of the head, which is moved.
            now: Time, in [s].
            heading: Heading of the torso in odometry, in [rad].
        """
        if self._start is None:
            self._start = now, heading
        time, before = self._start
        turned = wrap_angle(heading - before)
        timed_out = now - time >= MAX_DURATION
        half_time = now - time >= 0.5 * MAX_DURATION
        done = not self._behind or abs(turned) >= BODY_TURN or half_time
        gaze.search(stay=not done and gaze.scan_ends == SCAN_ENDS - 1)
        if not self._behind or timed_out:
            self.turning = 0.0
        elif gaze.scan_ends < SCAN_ENDS:
            self.turning = RIGHT
        else:
            back = abs(turned) > HEADING_TOLERANCE
            self.turning = -copysign(1.0, turned) if back else 0.0
