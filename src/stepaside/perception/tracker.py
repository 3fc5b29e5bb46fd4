"""Which of the things seen is the other, and where it is by now."""

from collections.abc import Sequence
from itertools import count

from .track import ANYBODY, GATE, MotionModel, Observation, TargetTrack

IDENTITY = 5.0  # how long a thing stays the other robot unseen, in [s]
PATIENCE = 4.0  # how long a confirmed thing is remembered, in [s]
FRESH = 0.3  # age up to which nobody doubts a sighting, in [s]
LAPSE = 0.5  # of recognition that does not make it another, in [s]
SAME = 0.15  # distance within which two tracks are one thing, in [m]
TALL = 0.75  # height of what is no robot but may be a person, in [m]
BROAD = 0.35  # distance within which two tall tracks are one person, in [m]
DOUBT = 0.6  # deviation beyond which memory is worth nothing, in [m]


class Tracker:
    """Follows things through frames; says which one counts.

    A thing is confirmed by several frames, so that one wrong frame does
    not make anybody move. Of the confirmed ones the other robot counts
    most, when it was recognised lately, and else the nearest.

    Attributes:
        tracks: Everything followed.
    """

    def __init__(self, motion: MotionModel = ANYBODY) -> None:
        """Follow nothing yet.

        Args:
            motion: How what is followed moves.
        """
        self._motion = motion
        self.tracks: list[TargetTrack] = []
        self._numbers = count(1)

    def observe(
        self,
        seen: Sequence[Observation],
        *,
        founds: bool = True,
        walkers: bool = False,
    ) -> list[TargetTrack]:
        """Take in everything that one frame shows.

        Args:
            seen: Observations; the best fitting one updates a track.
            founds: Whether what fits no track begins one.
            walkers: Whether it tells only of who was seen to walk.

        Returns:
            Tracks that were updated or begun.
        """
        fresh = list(seen)
        updated = []
        for track in sorted(self.tracks, key=lambda t: -t.seen_at):
            if not fresh:
                break
            if walkers and not track.walked:
                continue
            best = min(fresh, key=track.misfit)
            if track.misfit(best) <= GATE:
                track.correct(best)
                track.count(True)
                fresh.remove(best)
                updated.append(track)
        if founds:
            begun = [
                TargetTrack(each, next(self._numbers), self._motion)
                for each in fresh
            ]
            self.tracks += begun
            updated += begun
        return updated

    def main(self, now: float, x: float, y: float) -> TargetTrack | None:
        """The track that counts at a time, for a robot at a place."""
        self.tidy(now)
        known = [track for track in self.tracks if track.confirmed]
        named = [t for t in known if now - t.identified_at < IDENTITY]
        if named:
            # A late one may be a mistake: the oldest still recognised.
            newest = max(t.identified_at for t in named)
            return min(
                (t for t in named if newest - t.identified_at < LAPSE),
                key=lambda t: t.begun_at,
            )
        return min(known, key=lambda t: t.away_from(x, y, now), default=None)

    def tidy(self, now: float) -> None:
        """Forget what was not seen for long, and merge what is one thing."""
        self.tracks = [
            track
            for track in self.tracks
            if not track.hopeless
            and now - track.seen_at < (PATIENCE if track.confirmed else 1.0)
            and (
                now - track.seen_at < FRESH or track.deviation_at(now) < DOUBT
            )
        ]
        self._merge(now)

    def _merge(self, now: float) -> None:
        """Drop the younger of two tracks of the same thing."""
        kept: list[TargetTrack] = []
        for track in sorted(self.tracks, key=lambda t: t.begun_at):
            x, y = track.place_at(now)
            for older in kept:
                tall = min(track.height, older.height) > TALL
                same = BROAD if tall else SAME
                if older.away_from(x, y, now) < same and (
                    track.seen_at - older.seen_at < LAPSE
                ):
                    older.take_over(track)
                    break
            else:
                kept.append(track)
        self.tracks = kept
