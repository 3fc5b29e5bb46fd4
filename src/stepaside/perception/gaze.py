"""Motion of the head: scan, follow a target, glance aside, search."""

from bisect import bisect_right
from math import atan2, copysign, hypot, radians
from typing import NamedTuple

from ..core.poses import Array, wrap_angle
from ..robots.robot_tree import BodySize
from .track import TALL

FOLLOW_SPEED = 3.0  # of the head while it follows, in [rad/s]
SCAN_SPEED = 3.0  # of the head during a scan, in [rad/s]
SCAN_PITCH = radians(8.0)  # of the head during a scan, downward
MAX_YAW = radians(115.0)  # of the head during a scan and a glance
ROBOT_MIDDLE = 0.56  # of the height of a robot, at which the head looks
HALF_VIEW = radians(20.0)  # from the image centre to its usable upper edge
PERSON_TOP = 1.09  # height up to which a person is held in view, in [m]
MAX_UPWARD = radians(13.0)  # pitch for a person: the floor stays in view
OFTEN = 2.0  # between glances of a robot that walks backward, in [s]
SELDOM = 4.0  # between glances of a robot that walks forward, in [s]
GLANCE_DURATION = 0.9  # including the motion of the head, in [s]
MIN_DISTANCE = 0.8  # of the target of a glance: nearer, depth is lost, in [m]
MAX_TURN = 2.3  # from the target during a glance, in [rad]
SCAN_ENDS = 2
RIGHT = -1.0  # the body turns away from the first side of the scan
# Turn of the body that brings the floor behind into view: the head yaws 115
# degrees to either side, and its camera sees 29 degrees more, in [rad].
BODY_TURN = 1.3
HEADING_TOLERANCE = 0.15  # of the turn back to the first heading, in [rad]
MAX_DURATION = 10.0  # of a scan, in [s]


class GazeTarget(NamedTuple):
    """Target of the gaze."""

    bearing: float  # direction from the heading of the torso [rad]
    distance: float  # distance from the camera [m]
    height: float  # observed height [m]
    camera_height: float  # height of the own camera [m]


class Glances:
    """Periodic glances over alternate shoulders while following a target."""

    def __init__(self, tick: float, every: float = OFTEN) -> None:
        self._interval = round(every / tick)
        self._glance_ticks = round(GLANCE_DURATION / tick)
        self._ticks, self._side = 0, 1.0

    def direction(self, bearing: float, distance: float) -> float:
        """Return the bearing of the target or of a glance; call every tick.

        The head does not look away from a very near target.
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


class RoomScan:
    """Scan of the head to both sides, and optionally behind the body.

    A robot that walks backward also turns on the spot, away from the first
    side of the scan, and holds the head at the second end until the floor
    behind is visible or half of the time has passed. It then turns back to
    its first heading, from which the game begins.
    """

    def __init__(self, *, behind: bool) -> None:
        self._behind = behind
        self.turning = 0.0
        self._start: tuple[float, float] | None = None

    def lasts(self, gaze: "HeadControl") -> bool:
        """Return whether the scan is incomplete."""
        return gaze.scan_ends < SCAN_ENDS or self.turning != 0.0

    def look(self, gaze: "HeadControl", now: float, heading: float) -> None:
        """Advance the scan by one tick; see :meth:`HeadControl.move`."""
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


class HeadControl:
    """Head motion at a limited speed within the joint ranges."""

    def __init__(
        self,
        coupling: Array,
        tick: float,
        size: BodySize,
        *,
        glances: Glances | None = None,
        scan: RoomScan | None = None,
    ) -> None:
        """Start straight ahead at the pitch of a scan.

        The coupling has rows of yaw, least and greatest pitch, [rad]. After a
        scan of the room, if any, a signal starts the game.
        """
        self._glances, self._scan = glances, scan
        self._started = scan is None
        self._size = size
        self._yaws, self._low, self._high = coupling.tolist()
        self.reach: float = self._yaws[-1]
        self._tick = tick
        self._side = 1.0
        self.yaw, self.pitch = 0.0, SCAN_PITCH
        self.searching = True
        self.scan_ends = 0

    def follow(self, target: GazeTarget) -> None:
        """Turn towards a target, and upward for a person nearby."""
        bearing, distance, height, height_camera = target
        self.searching = False
        bearing = wrap_angle(bearing)
        # A scan after losing it starts on its side.
        self._side = 1.0 if bearing >= self.yaw else -1.0
        nearest = max(distance - 0.06, 0.1)
        if height > TALL:
            # Nearby not all fits in the image: the head matters most.
            middle = ROBOT_MIDDLE * self._size.height
            elevation_top = atan2(PERSON_TOP - height_camera, nearest)
            pitch = min(
                atan2(height_camera - middle, distance),
                HALF_VIEW - elevation_top,
            )
            pitch = max(pitch, -MAX_UPWARD)
        else:
            # The lower end of the trim gives the distance, but only with the
            # shoulders in view, too, is its middle that of the body.
            low, high = self._size.trim
            below = atan2(height_camera - low, nearest)
            above = atan2(high - height_camera, nearest)
            lowest = min(below - HALF_VIEW, HALF_VIEW)
            pitch = max(0.5 * (below - above), lowest)
        self._turn(bearing, pitch, FOLLOW_SPEED)

    def search(self, *, stay: bool = False) -> None:
        """Scan from side to side, or to the next end and stay there."""
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

    @property
    def turning(self) -> float:
        """Turn on the spot for the scan: 1 left, -1 right, 0 none."""
        return 0.0 if self._scan is None else self._scan.turning

    @property
    def is_ready(self) -> bool:
        """Whether the scan of the room, if any, is complete."""
        return self._scan is None or not self._scan.lasts(self)

    @property
    def scans(self) -> bool:
        """Whether the scan lasts, or the robot waits for the game to start."""
        return not (self._started and self.is_ready)

    def start(self) -> None:
        """Receive the signal that the game begins."""
        self._started = True

    def move(
        self, now: float, heading: float, target: GazeTarget | None
    ) -> None:
        """Move the head by one tick; without a target it searches."""
        if self.scans and self._scan is not None:
            self._scan.look(self, now, heading)
        elif self.scans or target is None:
            self.search()
        else:
            if self._glances is not None:
                bearing = self._glances.direction(*target[:2])
                target = target._replace(bearing=bearing)
            self.follow(target)
