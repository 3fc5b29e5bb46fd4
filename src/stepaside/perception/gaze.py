"""Where to look: at the other, or for it."""

from math import atan2, hypot, radians

import numpy as np

from ..core.poses import Array, wrap_angle
from .tracker import TALL

SPEED = 3.0  # of the head while it follows, in [rad/s]
SCAN_SPEED = 3.0  # of the head while it searches, in [rad/s]
SCAN_PITCH = radians(8.0)  # downward, while it searches
REACH = radians(115.0)  # of the yaw while it searches
MIDDLE = 0.28  # height of a robot that is looked at, in [m]
CROWN = 0.54  # height of the upper end of a robot's trim, in [m]
HALF = radians(20.0)  # upward from the middle of an image, still in it
LOOKOUT = 0.46  # height of the eyes, in [m]
HIPS = 1.05  # height up to which somebody taller is kept in view, in [m]
UPWARD = radians(13.0)  # at most for it: the floor stays in view, too
OFTEN = 2.0  # between two glances of one who walks backward, in [s]
SELDOM = 4.0  # of one who walks where it looks, in [s]
LONG = 0.9  # of a glance, the way there included, in [s]
TOO_NEAR = 0.8  # to look away: no depth tells where it is meanwhile, in [m]
AWAY = 2.3  # from the other at most, or it is lost, in [rad]


class Gaze:
    """Turns the head within its ranges and a calm speed.

    Attributes:
        yaw: Target of the yaw, in [rad].
        pitch: Target of the pitch, in [rad].
        searching: Whether it scans.
        turned: How often it turned back at an end of a scan.
    """

    def __init__(self, coupling: Array, tick: float) -> None:
        """Look ahead, and a little down.

        Args:
            coupling: Yaw, least and greatest pitch, in [rad]. Shape (3, n).
            tick: Control period, in [s].
        """
        self._yaws, self._low, self._high = coupling
        self._tick = tick
        self._side = 1.0
        self.yaw, self.pitch = 0.0, SCAN_PITCH
        self.searching = True
        self.turned = 0

    def follow(
        self, bearing: float, distance: float, height: float = 0.0
    ) -> None:
        """Look at something, and up as somebody tall comes near.

        Args:
            bearing: Its direction from the heading of the torso, in [rad].
            distance: Its distance, in [m].
            height: How high it rises at least, in [m].
        """
        if self.searching:
            self.searching = False
        bearing = wrap_angle(bearing)
        # Should it leave, the search begins on its side.
        self._side = 1.0 if bearing >= self.yaw else -1.0
        # From near not all is in view: rather the head than the feet.
        tall = height > TALL
        top = HIPS if tall else CROWN
        crown = atan2(top - LOOKOUT, max(distance - 0.06, 0.1))
        pitch = min(atan2(LOOKOUT - MIDDLE, distance), HALF - crown)
        pitch = max(pitch, -UPWARD) if tall else pitch
        self._turn(bearing, pitch, SPEED)

    def search(self, *, stay: bool = False) -> None:
        """Sweep from side to side.

        Args:
            stay: Whether to stay at the end of a scan.
        """
        self.searching = True
        edge = min(REACH, float(self._yaws[-1]))
        if self._side * self.yaw >= edge - 1e-6 and not stay:
            self._side = -self._side
            self.turned += 1
        self._turn(self._side * edge, SCAN_PITCH, SCAN_SPEED)

    def _turn(self, yaw: float, pitch: float, speed: float) -> None:
        step = speed * self._tick
        yaw = min(max(yaw, float(self._yaws[0])), float(self._yaws[-1]))
        to_yaw, to_pitch = yaw - self.yaw, pitch - self.pitch
        length = hypot(to_yaw, to_pitch)
        share = 1.0 if length <= step else step / length
        self.yaw += share * to_yaw
        self.pitch += share * to_pitch
        low = float(np.interp(self.yaw, self._yaws, self._low))
        high = float(np.interp(self.yaw, self._yaws, self._high))
        self.pitch = min(max(self.pitch, low), high)


class Glances:
    """Looks over one shoulder and the other, while somebody is followed."""

    def __init__(self, tick: float, every: float = OFTEN) -> None:
        """Begin with a while of looking at the other.

        Args:
            tick: Control period, in [s].
            every: Time between two glances, in [s].
        """
        self._every, self._long = round(every / tick), round(LONG / tick)
        self._passed = 0
        self._side = 1.0

    def turned(self, bearing: float, distance: float) -> float:
        """Where to look at a tick instead of at somebody.

        Args:
            bearing: Direction of who is followed, from the torso, in [rad].
            distance: Distance, in [m]; from one who is very near, nobody
                looks away.

        Returns:
            Direction to look in, in [rad].
        """
        self._passed += 1
        if self._passed < self._every or distance < TOO_NEAR:
            return bearing
        if self._passed == self._every and not self._is_beside(bearing):
            self._side = -self._side
        if self._passed >= self._every + self._long:
            self._passed, self._side = 0, -self._side
            return bearing
        return self._side * REACH if self._is_beside(bearing) else bearing

    def _is_beside(self, bearing: float) -> bool:
        """Whether a look over the shoulder is soon back at a bearing."""
        return abs(self._side * REACH - wrap_angle(bearing)) < AWAY
