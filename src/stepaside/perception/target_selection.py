"""Who counts of all that is followed, and who is looked at."""

from collections.abc import Sequence
from math import hypot
from typing import Protocol

from .track import TargetTrack
from .tracker import Tracker

UNSEEN = 1.0  # after which nobody is looked at any more, in [s]
STARE = 1.2  # unknown things that rest are looked at up to here, in [m]
MOVING = 0.08  # speed from which a thing moves, in [m/s]


class TargetSelection(Protocol):
    """What a robot makes of the tracks that it follows."""

    def main(
        self, tracker: Tracker, now: float, x: float, y: float
    ) -> TargetTrack | None:
        """The track that counts, if any.

        Args:
            tracker: What is followed.
            now: Time, in [s].
            x: Own place in odometry, in [m].
            y: Likewise.
        """

    def look(
        self,
        tracks: Sequence[TargetTrack],
        main: TargetTrack | None,
        now: float,
        x: float,
        y: float,
    ) -> TargetTrack | None:
        """The track to look at; None to look about.

        Args:
            tracks: Everything followed.
            main: What counts.
            now: Time, in [s].
            x: Own place in odometry, in [m].
            y: Likewise.
        """

    def settled(
        self, track: TargetTrack, now: float, x: float, y: float
    ) -> bool:
        """Whether it is known well enough to begin to move.

        Args:
            track: What counts.
            now: Time, in [s].
            x: Own place in odometry, in [m].
            y: Likewise.
        """


def lately_seen(
    tracks: Sequence[TargetTrack], main: TargetTrack | None, now: float
) -> list[TargetTrack]:
    """Tracks that may be looked at, what counts before all others.

    Args:
        tracks: Everything followed.
        main: What counts.
        now: Time, in [s].
    """
    ordered = [] if main is None else [main]
    ordered += [track for track in tracks if track is not main]
    return [track for track in ordered if now - track.seen_at <= UNSEEN]


class RobotSelection:
    """Looks for a robot that is known by its trim."""

    def main(
        self, tracker: Tracker, now: float, x: float, y: float
    ) -> TargetTrack | None:
        """Who was recognised lately, and else the nearest."""
        return tracker.main(now, x, y)

    def look(
        self,
        tracks: Sequence[TargetTrack],
        main: TargetTrack | None,
        now: float,
        x: float,
        y: float,
    ) -> TargetTrack | None:
        """What counts, and else what is near or moves."""
        for track in lately_seen(tracks, main, now):
            named = now - track.identified_at < UNSEEN
            moves = hypot(*track.velocity) > MOVING and track.confirmed
            if named or track.away_from(x, y, now) < STARE or moves:
                return track
        return None

    def settled(
        self, track: TargetTrack, now: float, x: float, y: float
    ) -> bool:
        """Always: where a robot is that is near decides."""
        return True
