"""Selection of the main track and of the target of the gaze."""

from collections.abc import Sequence
from math import hypot
from typing import Protocol

from .track import TargetTrack
from .tracker import Tracker

MAX_GAZE_AGE = 1.0  # of a track at which the head looks, in [s]
GAZE_RADIUS = 1.2  # within which the head looks at any track, in [m]
MOVING = 0.08  # speed of a moving track, in [m/s]
NEARER = 0.9  # relative distance from which another opponent is taken
RECOGNISED = 2.5  # how long an unnamed track stays without trim, in [s]
GLANCE = 0.6  # duration of a glance at an unseen opponent, in [s]
GLANCE_PAUSE = 1.2  # between two glances, in [s]
UNSEEN = 0.5  # age of the last image from which an opponent is unseen, in [s]


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


class UnnamedSelection:
    """Target selection among robots of one trim, which have no names.

    Recognised tracks are opponents, as many as there are; of more, where
    robots overlap in images, the most certain ones. The nearest is the main
    one, and another one than at present only when that is nearer by a tenth.
    The head looks at the main track, and now and then where another was last
    seen. Unrecognised objects are no targets: they may be teammates.
    """

    def __init__(self, tracker: Tracker, most: int) -> None:
        """Select among the tracks of a tracker.

        Args:
            tracker: The tracker.
            most: Number of opponents.
        """
        self._tracker, self._most = tracker, most
        self._present = 0  # number of the main track

    def recognised(self, now: float) -> list[TargetTrack]:
        """Return the confirmed tracks recognised by their trim.

        Args:
            now: Time, in [s].
        """
        self._tracker.prune(now)
        recognised = [
            track
            for track in self._tracker.tracks
            if track.confirmed and now - track.identified_at < RECOGNISED
        ]
        recognised.sort(key=lambda track: track.deviation_at(now))
        return recognised[: self._most]

    def main(self, now: float, x: float, y: float) -> TargetTrack | None:
        """Return the nearest recognised track, with hysteresis.

        ``x`` and ``y`` are the own position in odometry, in [m].
        """
        chosen = min(
            self.recognised(now),
            key=lambda t: (
                t.distance_from(x, y, now)
                * (NEARER if t.number == self._present else 1.0)
            ),
            default=None,
        )
        self._present = 0 if chosen is None else chosen.number
        return chosen

    def look(
        self, main: TargetTrack | None, now: float, x: float, y: float
    ) -> TargetTrack | None:
        """Return the main track, or another one that is due for a glance.

        ``x`` and ``y`` are the own position in odometry, in [m].
        """
        if main is None or now - main.observed_at > MAX_GAZE_AGE:
            return None
        unseen = [
            track
            for track in self.recognised(now)
            if now - track.imaged_at > UNSEEN
        ]
        if unseen and now % (GLANCE + GLANCE_PAUSE) < GLANCE:
            return min(unseen, key=lambda t: t.imaged_at)
        return main

    def settled(
        self, track: TargetTrack, now: float, x: float, y: float
    ) -> bool:
        """Return true: the position of a robot in odometry is enough."""
        return True

    def target_id(self, track: TargetTrack) -> int:
        """Return the number of the track."""
        return track.number


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
