"""Obstacles known to a robot: none, a given room, or a map."""

from ..arena import NO_OBSTACLES, ObstacleSet, Room
from ..core.poses import Pose
from ..perception.floor_map import CELL, FloorMap
from ..perception.measurement import RobotState

HERE = Pose(0.0, 0.0, 0.0)
AHEAD = 2.0  # horizon for moving obstacles: two steps, in [s]
REFRESH_PERIOD = 0.25  # of obstacles that may change, in [s]


class Surroundings:
    """Obstacles known to a robot: none, on an open floor."""

    solids = NO_OBSTACLES
    pose_odometry_in_map = HERE
    map_error = 0.0

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Update from a measurement; the pose of the CoM is in odometry."""


class KnownRoom(Surroundings):
    """A given room, with a sensor for the pose in it.

    Odometry that only counts steps drifts; the measured pose aligns the
    odometry frame with the room. The room also gives the motion of pushed
    boxes, which cover the floor until a halt begun with the next step has
    ended.
    """

    def __init__(self, room: Room, start: Pose) -> None:
        """Begin at time zero, with the pose of the odometry in the room."""
        self._room, self._next = room, 0.0
        self.solids = ObstacleSet(room.solids_at(0.0, AHEAD))
        self.pose_odometry_in_map = start

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Align odometry with the measured pose; update moving obstacles."""
        if measurement.pose_in_room is not None:
            self.pose_odometry_in_map = measurement.pose_in_room.compose(
                pose.inverse()
            )
        now = measurement.time
        if self._room.moving and now >= self._next - 1e-9:
            self._next = now + REFRESH_PERIOD
            self.solids = ObstacleSet(self._room.solids_at(now, AHEAD))


class MappedRoom(Surroundings):
    """Map from the own depth camera, in odometry.

    Unknown cells are obstacles, too, if unknown floor counts as occupied.
    """

    map_error = CELL

    def __init__(self, floor: FloorMap, *, unknown_is_free: bool) -> None:
        """Begin without obstacles; perception updates the map."""
        self._floor, self._unseen_is_free = floor, unknown_is_free
        self._read, self._next = 0, 0.0

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Read the map again if it has changed, a few times in each step."""
        now, version = measurement.time, self._floor.version
        if now < self._next - 1e-9 or version == self._read:
            return
        self._read, self._next = version, now + REFRESH_PERIOD
        known = self._floor.occupied()
        if not self._unseen_is_free:
            known += self._floor.unknown(pose[:2])
        self.solids = ObstacleSet(known)
