"""Looking all around before a game begins, to map what stands there."""

from math import copysign

from ..core.poses import wrap_angle
from .gaze import Gaze

BOTH = 2  # ends of a scan
AWAY = -1.0  # to the right, from where the head looks first
# How far the body turns so that the head sees what was behind it: it reaches
# 115 degrees to either side, and its camera 29 more.
BEHIND = 1.3  # [rad]
FACING = 0.15  # from where it faced first, it faces there again, in [rad]
LONGEST = 10.0  # for turns of the body, in [s]


class RoomScan:
    """One look to either end of the head's reach, and behind.

    Who walks backward turns on the spot meanwhile, away from where it looks
    first, and keeps looking over the other shoulder until it has seen what
    was behind it, or half of the time is over; then it turns back to where
    it faced, so that the game begins from there.

    Attributes:
        behind: Whether the body turns, and what is behind is looked at.
        turning: How the body is to turn on the spot meanwhile: 1 to the
            left, -1 to the right, 0 not at all.
    """

    def __init__(self) -> None:
        """Have seen nothing yet."""
        self.behind = False
        self.turning = 0.0
        self._began: tuple[float, float] | None = None

    def lasts(self, gaze: Gaze) -> bool:
        """Return whether the scan is incomplete."""
        return gaze.turned < BOTH or self.turning != 0.0

    def look(self, gaze: Gaze, now: float, heading: float) -> None:
        """Turn the head on.

        Args:
            gaze: Where the head looks.
            now: Time, in [s].
            heading: Of the torso in odometry, in [rad].
        """
        if self._began is None:
            self._began = now, heading
        time, before = self._began
        aside = wrap_angle(heading - before)
        late = now - time >= LONGEST
        half = now - time >= 0.5 * LONGEST
        done = not self.behind or abs(aside) >= BEHIND or half
        gaze.search(stay=not done and gaze.turned == BOTH - 1)
        if not self.behind or late:
            self.turning = 0.0
        elif gaze.turned < BOTH:
            self.turning = AWAY
        else:
            back = abs(aside) > FACING
            self.turning = -copysign(1.0, aside) if back else 0.0
