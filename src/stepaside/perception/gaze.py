"""Gaze control: follow a target, scan for it, glance aside."""

from bisect import bisect_right
from math import atan2, hypot, radians

from ..core.poses import Array, wrap_angle
from .tracker import TALL

FOLLOW_SPEED = 3.0  # of the head while it follows, in [rad/s]
SCAN_SPEED = 3.0  # of the head during a scan, in [rad/s]
SCAN_PITCH = radians(8.0)  # of the head during a scan, downward
MAX_YAW = radians(115.0)  # of the head during a scan and a glance
ROBOT_MIDDLE = 0.28  # height of a robot at which the head looks, in [m]
ROBOT_TOP = 0.54  # height of the upper end of a robot's trim, in [m]
HALF_VIEW = radians(20.0)  # from the image centre to its usable upper edge
CAMERA_HEIGHT = 0.46  # of a NAO, in [m]
PERSON_TOP = 1.05  # height up to which a person is held in view, in [m]
MAX_UPWARD = radians(13.0)  # pitch for a person: the floor stays in view
OFTEN = 2.0  # between glances of a robot that walks backward, in [s]
SELDOM = 4.0  # between glances of a robot that walks forward, in [s]
GLANCE_DURATION = 0.9  # including the motion of the head, in [s]
MIN_DISTANCE = 0.8  # of the target of a glance: nearer, depth is lost, in [m]
MAX_TURN = 2.3  # from the target during a glance, in [rad]


class Gaze:
    """Head motion at a limited speed within the joint ranges.

    Attributes:
        yaw: Target of the head yaw, in [rad].
        pitch: Target of the head pitch, in [rad].
        searching: Whether the head scans.
        scan_ends: Number of times that a scan has reached one of its ends.
        reach: Greatest yaw to either side, in [rad].
    """

    def __init__(
        self,
        coupling: Array,
        tick: float,
        camera_height: float = CAMERA_HEIGHT,
    ) -> None:
        """Start straight ahead at the pitch of a scan.

        Args:
            coupling: Rows of yaw, minimum and maximum pitch, in [rad]. Shape
                (3, n).
            tick: Control period, in [s].
            camera_height: Height of the camera, in [m].
        """
        self._camera_height = camera_height
        self._yaws, self._low, self._high = coupling.tolist()
        self.reach: float = self._yaws[-1]
        self._tick = tick
        self._side = 1.0
        self.yaw, self.pitch = 0.0, SCAN_PITCH
        self.searching = True
        self.scan_ends = 0

    def follow(
        self, bearing: float, distance: float, height: float = 0.0
    ) -> None:
        """Turn towards a target, and upward for a person nearby.

        Args:
            bearing: Direction of the target from the heading of the torso,
                in [rad].
            distance: Distance of the target, in [m].
            height: Observed height of the target, in [m].
        """
        if self.searching:
            self.searching = False
        bearing = wrap_angle(bearing)
        # A scan after losing it starts on its side.
        self._side = 1.0 if bearing >= self.yaw else -1.0
        # Nearby not all fits in the image: the head matters most.
        tall = height > TALL
        top = PERSON_TOP if tall else ROBOT_TOP
        height_camera = self._camera_height
        elevation_top = atan2(top - height_camera, max(distance - 0.06, 0.1))
        pitch = min(
            atan2(height_camera - ROBOT_MIDDLE, distance),
            HALF_VIEW - elevation_top,
        )
        pitch = max(pitch, -MAX_UPWARD) if tall else pitch
        self._turn(bearing, pitch, FOLLOW_SPEED)

    def search(self, *, stay: bool = False) -> None:
        """Scan from side to side.

        Args:
            stay: Whether to stop at the next end of the scan.
        """
        self.searching = True
        edge = min(MAX_YAW, self.reach)
        if self._side * self.yaw >= edge - 1e-6 and not stay:
            self._side = -self._side
            self.scan_ends += 1
        self._turn(self._side * edge, SCAN_PITCH, SCAN_SPEED)

    def _turn(self, yaw: float, pitch: float, speed: float) -> None:
        step = speed * self._tick
        yaw = min(max(yaw, self._yaws[0]), self._yaws[-1])
        to_yaw, to_pitch = yaw - self.yaw, pitch - self.pitch
        length = hypot(to_yaw, to_pitch)
        fraction = 1.0 if length <= step else step / length
        self.yaw += fraction * to_yaw
        self.pitch += fraction * to_pitch
        low, high = self._pitch_range(self.yaw)
        self.pitch = min(max(self.pitch, low), high)

    def _pitch_range(self, yaw: float) -> tuple[float, float]:
        """Return the pitch limits at a yaw in range, all in [rad]."""
        yaws, low, high = self._yaws, self._low, self._high
        i = min(max(bisect_right(yaws, yaw) - 1, 0), len(yaws) - 2)
        along, width = yaw - yaws[i], yaws[i + 1] - yaws[i]
        return (
            (low[i + 1] - low[i]) / width * along + low[i],
            (high[i + 1] - high[i]) / width * along + high[i],
        )


class NoGlances:
    """Gaze that stays on its target."""

    def direction(self, bearing: float, distance: float) -> float:
        """Return the bearing of the target, in [rad]."""
        return bearing


class Glances:
    """Periodic glances over alternate shoulders while following a target."""

    def __init__(self, tick: float, every: float = OFTEN) -> None:
        """Start with a full interval before the first glance.

        Args:
            tick: Control period, in [s].
            every: Time between two glances, in [s].
        """
        self._interval, self._glance_ticks = (
            round(every / tick),
            round(GLANCE_DURATION / tick),
        )
        self._ticks = 0
        self._side = 1.0

    def direction(self, bearing: float, distance: float) -> float:
        """Return the direction to look in at this tick; call every tick.

        Args:
            bearing: Bearing of the target from the torso, in [rad].
            distance: Distance of the target, in [m]; the head does not look
                away from a very near one.

        Returns:
            Bearing of the target or of a glance, in [rad].
        """
        self._ticks += 1
        if self._ticks < self._interval or distance < MIN_DISTANCE:
            return bearing
        if self._ticks == self._interval and not self._is_in_reach(bearing):
            self._side = -self._side
        if self._ticks >= self._interval + self._glance_ticks:
            self._ticks, self._side = 0, -self._side
            return bearing
        return self._side * MAX_YAW if self._is_in_reach(bearing) else bearing

    def _is_in_reach(self, bearing: float) -> bool:
        """Return whether a glance to the current side is short enough."""
        return abs(self._side * MAX_YAW - wrap_angle(bearing)) < MAX_TURN
