"""Motion of the head: scan of the room, then follow, glance or search."""

from typing import NamedTuple

from .gaze import Gaze, Glances, NoGlances
from .room_scan import NoScan, RoomScan


class GazeTarget(NamedTuple):
    """Target of the gaze.

    Attributes:
        bearing: Direction from the heading of the torso, in [rad].
        distance: Distance from the torso, in [m].
        height: Observed height, in [m].
    """

    bearing: float
    distance: float
    height: float


class HeadControl:
    """Head motion of a robot before and during a game."""

    def __init__(
        self,
        gaze: Gaze,
        *,
        glances: Glances | NoGlances,
        scan: RoomScan | NoScan,
        awaits_start: bool = False,
    ) -> None:
        """Combine the parts.

        Args:
            gaze: Motion of the head at a limited speed.
            glances: Glances aside of a target.
            scan: Scan of the room before the game.
            awaits_start: Whether a signal starts the game; otherwise it
                begins with the end of the scan.
        """
        self._gaze, self._glances, self._scan = gaze, glances, scan
        self._started = not awaits_start

    @property
    def yaw(self) -> float:
        """Target of the head yaw, in [rad]."""
        return self._gaze.yaw

    @property
    def pitch(self) -> float:
        """Target of the head pitch, in [rad]."""
        return self._gaze.pitch

    @property
    def reach(self) -> float:
        """Greatest yaw to either side, in [rad]."""
        return self._gaze.reach

    @property
    def turning(self) -> float:
        """Turn on the spot for the scan: 1 left, -1 right, 0 none."""
        return self._scan.turning

    @property
    def is_ready(self) -> bool:
        """Whether the scan of the room, if any, is complete."""
        return not self._scan.lasts(self._gaze)

    @property
    def scans(self) -> bool:
        """Whether the scan lasts, or the robot waits for the game to start."""
        return not (self._started and self.is_ready)

    def start(self) -> None:
        """Receive the signal that the game begins."""
        self._started = True

    def move(
        self,
        now: float,
        heading_in_odometry: float,
        target: GazeTarget | None,
    ) -> None:
        """Move the head by one tick.

        Args:
            now: Time, in [s].
            heading_in_odometry: Heading of the torso, in [rad].
            target: Target to follow; None to search.
        """
        if self.scans:
            self._scan.look(self._gaze, now, heading_in_odometry)
        elif target is None:
            self._gaze.search()
        else:
            bearing, distance, height = target
            bearing = self._glances.direction(bearing, distance)
            self._gaze.follow(bearing, distance, height)
