"""What a robot knows of what stands around it."""

from typing import Protocol

from ...arena import NO_OBSTACLES, ObstacleSet, Room, obstacle_set
from ...core.poses import Pose
from ...perception.floor_map import CELL, FloorMap
from ...perception.measurement import Measurement
from ...robots.body_reference import BodyReference

HERE = Pose(0.0, 0.0, 0.0)
AHEAD = 2.0  # for which a map tells where things move: two steps, in [s]
REFRESHED = 0.25  # how often what may have changed is read again, in [s]


class Surroundings(Protocol):
    """What a robot knows of what stands around it.

    Attributes:
        solids: All that it knows of.
        frame: Pose of the own odometry in the frame in which they are.
        blur: How far off that may be, in [m].
    """

    blur: float

    @property
    def solids(self) -> ObstacleSet:
        """All that it knows of."""

    @property
    def frame(self) -> Pose:
        """Pose of the own odometry in the frame in which they are."""

    def note(self, measurement: Measurement, body: BodyReference) -> None:
        """Learn from what the sensors give at a tick.

        Args:
            measurement: What the sensors give.
            body: What was asked of the body for this tick, in odometry.
        """


class OpenFloor:
    """Nothing stands around, as far as anybody knows."""

    solids = NO_OBSTACLES
    frame = HERE
    blur = 0.0

    def note(self, measurement: Measurement, body: BodyReference) -> None:
        """Learn nothing."""


class KnownRoom:
    """A room that is known, and a sensor that tells the place in it.

    Odometry that only counts steps drifts: the place that the sensor tells
    keeps the frame of odometry where it is in the room. The map also tells
    where boxes are that somebody pushes about, and where they soon will be.

    Attributes:
        solids: All that stands in the room, and the floor that what moves
            covers until a halt begun with the next step is over.
        frame: Pose of the own odometry in the room.
        blur: 0, it is exact.
    """

    blur = 0.0

    def __init__(self, room: Room, start: Pose) -> None:
        """Know a room.

        Args:
            room: The room.
            start: Pose of the own odometry in it at first.
        """
        self._room, self._next = room, 0.0
        self.solids = obstacle_set(room.solids_at(0.0, AHEAD))
        self.frame = start

    def note(self, measurement: Measurement, body: BodyReference) -> None:
        """Take the place that is measured for the one that was planned."""
        if measurement.place is not None:
            x, y, _ = body.com
            planned = Pose(x, y, body.heading)
            self.frame = measurement.place.compose(planned.inverse())
        now = measurement.time
        if self._room.moving and now >= self._next - 1e-9:
            self._next = now + REFRESHED
            self.solids = obstacle_set(self._room.solids_at(now, AHEAD))


class MappedRoom:
    """A room as far as the own depth camera has seen it, in odometry.

    Attributes:
        solids: All that was seen to stand there, and, if unseen floor
            counts as taken, that as well.
        frame: Odometry itself.
        blur: A cell of the map.
    """

    frame = HERE
    blur = CELL

    def __init__(self, floor: FloorMap, *, unseen_is_free: bool) -> None:
        """Know nothing yet.

        Args:
            floor: Map that grows.
            unseen_is_free: Whether unseen floor counts as free.
        """
        self._floor, self._unseen_is_free = floor, unseen_is_free
        self.solids = NO_OBSTACLES
        self._read, self._next = 0, 0.0

    def note(self, measurement: Measurement, body: BodyReference) -> None:
        """Read the map again, a few times in each step."""
        now, version = measurement.time, self._floor.version
        if now < self._next - 1e-9 or version == self._read:
            return
        self._read, self._next = version, now + REFRESHED
        known = self._floor.taken()
        if not self._unseen_is_free:
            known += self._floor.unseen(body.com[:2])
        self.solids = obstacle_set(known)
