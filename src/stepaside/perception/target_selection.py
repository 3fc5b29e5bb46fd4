"""Selection of the main track and of the target of the gaze."""

from collections.abc import Sequence
from math import hypot

from ..core.poses import Pose, wrap_angle
from .measurement import Sighting
from .track import MAX_GAP, TargetTrack, Tracker

# Of every selection.
MAX_GAZE_AGE = 1.0  # of a track at which the head looks, in [s]
GAZE_RADIUS = 1.2  # within which the head looks at any track, in [m]
# Of robots.
MOVING = 0.08  # speed of a moving track, in [m/s]
GLANCE = 0.6  # duration of a glance at another track, in [s]
# Of people.
HORIZON = 4.0  # of the prediction at constant velocity, in [s]
APPROACHING = 1.0  # predicted distance below which the gaze stays, in [m]
HYSTERESIS = 0.3  # by which another track must pass nearer to win, in [m]
PAUSE_RESTING = 3.0  # between glances at a track that rests, in [s]
PAUSE_WALKING = 1.0  # between glances at a track that walks, in [s]
SETTLING = 0.6  # observation of an approaching person before moving, in [s]
SETTLING_PASSING = 1.1  # the same of a person who may pass by, in [s]
STRAIGHT = 0.45  # predicted distance below which a person does not pass, [m]
NEW = 1.0  # age of a new track, in [s]
SOON = 1.6  # time to reach NEAR below which a new track settles, in [s]
NEAR = 0.7  # distance of a near person, in [m]


class TargetSelection:
    """Selection of tracks as targets at an own position (x, y)."""

    def __init__(self, tracker: Tracker) -> None:
        self.tracker = tracker

    def main(self, now: float, x: float, y: float) -> TargetTrack | None:
        """Return the main track: one recognised recently, else the nearest."""
        return self.tracker.main(now, x, y)

    def look(
        self, main: TargetTrack | None, now: float, x: float, y: float
    ) -> TargetTrack | None:
        """Return a recognised, near or moving track to look at, or None."""
        for track in recent_tracks(self.tracker.tracks, main, now):
            recognised = now - track.identified_at < MAX_GAZE_AGE
            moves = hypot(*track.velocity) > MOVING and track.confirmed
            near = track.distance_from(x, y, now) < GAZE_RADIUS
            if recognised or near or moves:
                return track
        return None

    def sighting(
        self, track: TargetTrack, now: float, pose_in_odometry: Pose
    ) -> Sighting:
        """Return the sighting of a track from a pose of the torso."""
        x, y, heading = pose_in_odometry
        bearing = wrap_angle(track.bearing_from(x, y, now) - heading)
        distance = track.distance_from(x, y, now)
        spread = track.deviation_at(now)
        return Sighting(now, bearing, distance, spread=spread)


def recent_tracks(
    tracks: Sequence[TargetTrack], main: TargetTrack | None, now: float
) -> list[TargetTrack]:
    """Return tracks observed recently, the main one first."""
    ordered = [] if main is None else [main]
    ordered += [track for track in tracks if track is not main]
    return [
        track for track in ordered if now - track.observed_at <= MAX_GAZE_AGE
    ]


class PeopleSelection(TargetSelection):
    """Target selection that prefers approaching people to objects at rest.

    A wall may be nearer than any person and would hold the gaze. Tracks that
    have walked therefore come first, and among them the one with the
    smallest predicted distance. The gaze follows a track that will come near
    or is too near to be measured precisely; the head only glances at all
    others, long enough to detect whether they walk.
    """

    def __init__(self, tracker: Tracker) -> None:
        super().__init__(tracker)
        self._main: TargetTrack | None = None
        # Start of the last glance at each track, in [s].
        self._glanced: dict[TargetTrack, float] = {}

    def main(self, now: float, x: float, y: float) -> TargetTrack | None:
        """Return the walking track that will be nearest, else the nearest."""
        self.tracker.prune(now)
        confirmed = [t for t in self.tracker.tracks if t.confirmed]
        walkers = [track for track in confirmed if track.has_walked]
        self._main = min(
            walkers or confirmed,
            key=lambda t: (
                closest_approach(t, now, x, y) - HYSTERESIS * (t is self._main)
            ),
            default=None,
        )
        return self._main

    def look(
        self, main: TargetTrack | None, now: float, x: float, y: float
    ) -> TargetTrack | None:
        """Return an approaching track, else one that is due for a glance."""
        tracks = self.tracker.tracks
        candidates = [
            track
            for track in recent_tracks(tracks, main, now)
            if not track.is_watched(now)
        ]
        for track in candidates:
            ahead = closest_approach(track, now, x, y)
            if track.has_walked and ahead < APPROACHING:
                return track
        near = [
            t for t in candidates if t.distance_from(x, y, now) < GAZE_RADIUS
        ]
        for track in near:
            known = track.has_walked or track.has_velocity(now)
            if now - track.observed_at <= MAX_GAZE_AGE and not known:
                return track
        begun = self._glanced
        self._glanced = {t: begun[t] for t in tracks if t in begun}
        for track in candidates:
            if not (track.confirmed or track in near):
                continue
            since = now - self._glanced.setdefault(track, now)
            pause = PAUSE_WALKING if track.has_walked else PAUSE_RESTING
            if since > GLANCE + pause:
                self._glanced[track], since = now, 0.0
            if since < GLANCE:
                return track
        return None

    def sighting(
        self, track: TargetTrack, now: float, pose_in_odometry: Pose
    ) -> Sighting:
        """Return the sighting of a track, with its number."""
        seen = super().sighting(track, now, pose_in_odometry)
        settled = self._is_settled(track, now, *pose_in_odometry[:2])
        return seen._replace(target_id=track.number, settled=settled)

    def _is_settled(
        self, track: TargetTrack, now: float, x: float, y: float
    ) -> bool:
        """Return whether a track was observed for long enough.

        While the head sweeps over a person, parts are detected whose middle
        seems to move, and the first steps do not show the direction of the
        walk. A new track nearby settles at once, for there is no time left.
        """
        if now - track.observed_at > MAX_GAP:
            return False
        watched = now - track.observed_since
        if watched >= SETTLING_PASSING:
            return True
        least = closest_approach(track, now, x, y)
        if watched >= SETTLING and least < STRAIGHT:
            return True
        away, speed = track.distance_from(x, y, now), hypot(*track.velocity)
        soon = away - NEAR < SOON * speed
        return now - track.started_at < NEW and soon and least < NEAR


def closest_approach(
    track: TargetTrack, now: float, x: float, y: float
) -> float:
    """Return how near a track will come at constant velocity, in [m]."""
    u, v = track.position_at(now)
    dx, dy = u - x, v - y
    vx, vy = track.drift
    square = vx * vx + vy * vy
    ahead = 0.0
    if square > 0.0:
        ahead = min(max(-(dx * vx + dy * vy) / square, 0.0), HORIZON)
    return hypot(dx + ahead * vx, dy + ahead * vy)
