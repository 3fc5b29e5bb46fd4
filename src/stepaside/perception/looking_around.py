"""Looking all around before a game begins, to map what stands there."""

from typing import Protocol

from ..poses import wrap_angle
from .gaze import Gaze

BOTH = 2  # ends of a scan
# How far the body turns so that the head sees what was behind it: it reaches
# 115 degrees to either side, and its camera 29 more.
BEHIND = 1.3  # [rad]
LONGEST = 8.0  # that a turn, or somebody else, is waited for, in [s]


class Looker(Protocol):
    """Who may look around."""

    @property
    def looking(self) -> bool:
        """Whether it still does."""


class LookAround:
    """One look to either end of the head's reach, and behind.

    Who walks backward turns on the spot meanwhile, away from where it looks
    first, and keeps looking over the other shoulder until it has seen what
    was behind it. Who has seen all may wait for others: a game begins when
    everybody has.

    Attributes:
        company: Who is waited for, if not for ever.
        behind: Whether the body turns, and what is behind is looked at.
    """

    def __init__(self) -> None:
        """Have seen nothing yet."""
        self.company: list[Looker] = []
        self.behind = False
        self._began: tuple[float, float] | None = None
        self._late = False

    def lasts(self, gaze: Gaze) -> bool:
        """Whether there is something left to look at, or somebody."""
        if gaze.turned < BOTH:
            return True
        return not self._late and any(each.looking for each in self.company)

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
        turned = abs(wrap_angle(heading - before)) >= BEHIND
        self._late = now - time >= LONGEST
        done = not self.behind or turned or self._late
        gaze.search(stay=not done and gaze.turned == BOTH - 1)
