"""Selection of the main track and of the target of the gaze."""

from collections.abc import Sequence
from math import hypot
from typing import Protocol

from .track import TargetTrack
from .tracker import Tracker

MAX_GAZE_AGE = 1.0  # of a track at which the head looks, in [s]
GAZE_RADIUS = 1.2  # within which the head looks at any track, in [m]
MOVING = 0.08  # speed of a moving track, in [m/s]


class TargetSelection(Protocol):
    """Selection of tracks of a tracker as targets."""

    def main(self, now: float, x: float, y: float) -> TargetTrack | None:
        """Return the main track: that of the opponent, if any.

        The tracker is pruned before.

        Args:
            now: Time, in [s].
            x: Own x in odometry, in [m].
            y: Own y in odometry, in [m].
        """

    def look(
        self, main: TargetTrack | None, now: float, x: float, y: float
    ) -> TargetTrack | None:
        """Return the track to look at; None to scan.

        Args:
            main: Main track.
            now: Time, in [s].
            x: Own x in odometry, in [m].
            y: Own y in odometry, in [m].
        """

    def settled(
        self, track: TargetTrack, now: float, x: float, y: float
    ) -> bool:
        """Return whether a track is reliable enough to start moving.

        Args:
            track: Main track.
            now: Time, in [s].
            x: Own x in odometry, in [m].
            y: Own y in odometry, in [m].
        """

    def target_id(self, track: TargetTrack) -> int:
        """Return the number by which sightings tell opponents apart.

        Args:
            track: Main track.
        """


def recent_tracks(
    tracks: Sequence[TargetTrack], main: TargetTrack | None, now: float
) -> list[TargetTrack]:
    """Return tracks observed recently, the main one first.

    Args:
        tracks: All tracks.
        main: Main track.
        now: Time, in [s].
    """
    ordered = [] if main is None else [main]
    ordered += [track for track in tracks if track is not main]
    return [
        track for track in ordered if now - track.observed_at <= MAX_GAZE_AGE
    ]


class RobotSelection:
    """Target selection of a robot that is recognised by its trim."""

    def __init__(self, tracker: Tracker) -> None:
        """Select among the tracks of a tracker."""
        self._tracker = tracker

    def main(self, now: float, x: float, y: float) -> TargetTrack | None:
        """Return the track recognised recently, else the nearest.

        ``x`` and ``y`` are the own position in odometry, in [m].
        """
        return self._tracker.main(now, x, y)

    def look(
        self, main: TargetTrack | None, now: float, x: float, y: float
    ) -> TargetTrack | None:
        """Return the recognised track, else one that is near or moves.

        ``x`` and ``y`` are the own position in odometry, in [m].
        """
        for track in recent_tracks(self._tracker.tracks, main, now):
            recognised = now - track.identified_at < MAX_GAZE_AGE
            moves = hypot(*track.velocity) > MOVING and track.confirmed
            if (
                recognised
                or track.distance_from(x, y, now) < GAZE_RADIUS
                or moves
            ):
                return track
        return None

    def settled(
        self, track: TargetTrack, now: float, x: float, y: float
    ) -> bool:
        """Return true: the position of a robot in odometry is enough."""
        return True

    def target_id(self, track: TargetTrack) -> int:
        """Return 0: there is one opponent."""
        return 0
