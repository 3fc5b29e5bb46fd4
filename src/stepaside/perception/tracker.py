"""Tracker of all objects, which selects the opponent."""

from collections.abc import Sequence
from itertools import count

from .track import GATE, PERSON_MOTION, MotionModel, Observation, TargetTrack

IDENTITY = 5.0  # how long a track stays recognised without trim, in [s]
MAX_AGE = 4.0  # of a confirmed track, in [s]
MAX_AGE_UNCONFIRMED = 1.0  # of any other track, in [s]
FRESH = 0.3  # age up to which a track is never dropped for its deviation
MAX_LAPSE = 0.5  # between the last observations of tracks of one object, [s]
MERGE_DISTANCE = 0.15  # of two tracks of one object, in [m]
TALL = 0.75  # height above which an object is no robot, in [m]
MERGE_DISTANCE_TALL = 0.35  # of two tracks of one person, in [m]
MAX_DEVIATION = 0.6  # of the predicted position of a track, in [m]


class Tracker:
    """Multi-object tracker with nearest-neighbour association.

    Several frames confirm a track, so that one wrong frame does not make the
    robot move.
    """

    def __init__(
        self, motion: MotionModel = PERSON_MOTION, *, several: bool = False
    ) -> None:
        self._motion, self._several = motion, several
        self.tracks: list[TargetTrack] = []
        self._numbers = count(1)

    def observe(
        self,
        observations: Sequence[Observation],
        *,
        may_start: bool = True,
        walked_only: bool = False,
    ) -> list[TargetTrack]:
        """Update or start tracks with observations of a frame; return them."""
        remaining = list(observations)
        updated = []
        for track in self._ordered(remaining):
            if not remaining:
                break
            if walked_only and not track.has_walked:
                continue
            best = min(remaining, key=track.mahalanobis_squared)
            if track.mahalanobis_squared(best) <= GATE:
                track.update(best)
                track.record_frame(True)
                remaining.remove(best)
                updated.append(track)
        if may_start:
            started = [
                TargetTrack(observation, next(self._numbers), self._motion)
                for observation in remaining
            ]
            self.tracks += started
            updated += started
        return updated

    def _ordered(
        self, observations: Sequence[Observation]
    ) -> list[TargetTrack]:
        """Return the tracks in the order in which they take observations."""
        if not self._several or not observations:
            return sorted(self.tracks, key=lambda t: -t.observed_at)
        return sorted(
            self.tracks,
            key=lambda t: min(map(t.mahalanobis_squared, observations)),
        )

    def main(self, now: float, x: float, y: float) -> TargetTrack | None:
        """Return the main track for a robot at a position in odometry."""
        self.prune(now)
        confirmed = [track for track in self.tracks if track.confirmed]
        recognised = [t for t in confirmed if now - t.identified_at < IDENTITY]
        if recognised:
            # A new one may be a false detection: the oldest wins.
            since = max(t.identified_at for t in recognised) - MAX_LAPSE
            newest = [t for t in recognised if t.identified_at > since]
            return min(newest, key=lambda t: t.started_at)
        return min(
            confirmed, key=lambda t: t.distance_from(x, y, now), default=None
        )

    def prune(self, now: float) -> None:
        """Drop outdated tracks, and merge tracks of the same object."""

        def keeps(track: TargetTrack) -> bool:
            age = now - track.observed_at
            most = MAX_AGE if track.confirmed else MAX_AGE_UNCONFIRMED
            if track.is_rejected or age >= most:
                return False
            return age < FRESH or track.deviation_at(now) < MAX_DEVIATION

        self.tracks = [track for track in self.tracks if keeps(track)]
        self._merge(now)

    def _merge(self, now: float) -> None:
        """Merge the younger of two tracks of one object into the older."""
        merged: list[TargetTrack] = []
        for track in sorted(self.tracks, key=lambda t: t.started_at):
            x, y = track.position_at(now)
            for older in merged:
                tall = min(track.height, older.height) > TALL
                limit = MERGE_DISTANCE_TALL if tall else MERGE_DISTANCE
                if older.distance_from(x, y, now) < limit and (
                    track.observed_at - older.observed_at < MAX_LAPSE
                ):
                    older.merge(track)
                    break
            else:
                merged.append(track)
        self.tracks = merged
