"""Whom to watch where people come and go, and walls stand near."""

from collections.abc import Sequence
from math import hypot

from .target_selection import STARE, UNSEEN, lately_seen
from .track import LAPSE, TargetTrack
from .tracker import Tracker

AHEAD = 4.0  # for which somebody is taken to walk on, in [s]
COMES = 1.0  # who comes nearer than this is not let out of sight, in [m]
KEPT = 0.3  # by which another must come nearer to count instead, in [m]
GLANCE = 0.6  # for which anything else is looked at, in [s]
AWAY = 3.0  # from one such glance to the next at what rests, in [s]
AGAIN = 1.0  # the same at who walks, in [s]
WATCHED = 0.6  # for which somebody must be seen who is to move it, in [s]
LONGER = 1.1  # the same of somebody who may pass, in [s]
STRAIGHT = 0.45  # who will come nearer than this seems not to pass, in [m]
NEW = 1.0  # since when nobody knew of somebody, in [s]
SOON = 1.6  # time in which somebody new would be near, in [s]
NEAR = 0.7  # in [m]


class PeopleSelection:
    """Watches who comes, and no more than glances at what rests.

    A wall is nearer than any person, and would hold the gaze for ever. So
    who was seen to walk counts before what was not, and of those who walk
    the one who will be nearest if all walk on. Only who will be near is
    followed, and what is too near to be seen sharply; at anything else the
    head looks now and then, long enough to see whether it walks.
    """

    def __init__(self) -> None:
        """Know nobody."""
        self._main: TargetTrack | None = None
        self._glanced: dict[
            TargetTrack, float
        ] = {}  # begin of the last, in [s]

    def main(
        self, tracker: Tracker, now: float, x: float, y: float
    ) -> TargetTrack | None:
        """Who walks and will be nearest; else what is nearest."""
        tracker.tidy(now)
        known = [track for track in tracker.tracks if track.confirmed]
        walkers = [track for track in known if track.walked]
        self._main = min(
            walkers or known,
            key=lambda t: nearest(t, now, x, y) - KEPT * (t is self._main),
            default=None,
        )
        return self._main

    def look(
        self,
        tracks: Sequence[TargetTrack],
        main: TargetTrack | None,
        now: float,
        x: float,
        y: float,
    ) -> TargetTrack | None:
        """Who comes; else what was not looked at for a while."""
        candidates = lately_seen(tracks, main, now)
        for track in candidates:
            if track.walked and nearest(track, now, x, y) < COMES:
                return track
        for track in candidates:
            near = track.away_from(x, y, now) < STARE
            seen = now - track.sighted_at <= UNSEEN
            if near and seen and not (track.walked or track.is_told(now)):
                return track
        begun = self._glanced
        self._glanced = {t: begun[t] for t in tracks if t in begun}
        for track in candidates:
            if not (track.confirmed or track.away_from(x, y, now) < STARE):
                continue
            since = now - self._glanced.setdefault(track, now)
            pause = AGAIN if track.walked else AWAY
            if since > GLANCE + pause:
                self._glanced[track], since = now, 0.0
            if since < GLANCE:
                return track
        return None

    def settled(
        self, track: TargetTrack, now: float, x: float, y: float
    ) -> bool:
        """Whether it was watched for a while, or there is no time for that.

        Of whom the head only sweeps by, parts are seen, and their middles
        seem to walk; and the first steps of a way do not tell where it
        leads: by how far somebody will pass takes longer to see than that
        they come. Only somebody who turns up near by leaves no time to see.
        """
        if now - track.seen_at > LAPSE:
            return False
        watched = now - track.watched_since
        if watched >= LONGER:
            return True
        least = nearest(track, now, x, y)
        if watched >= WATCHED and least < STRAIGHT:
            return True
        away, speed = track.away_from(x, y, now), hypot(*track.velocity)
        soon = away - NEAR < SOON * speed
        return now - track.begun_at < NEW and soon and least < NEAR


def nearest(track: TargetTrack, now: float, x: float, y: float) -> float:
    """Least distance from a place if somebody walks on for a while, in [m].

    Args:
        track: Who.
        now: Time, in [s].
        x: The place in odometry, in [m].
        y: Likewise.
    """
    u, v = track.place_at(now)
    dx, dy = u - x, v - y
    vx, vy = track.drift
    square = vx * vx + vy * vy
    ahead = 0.0
    if square > 0.0:
        ahead = min(max(-(dx * vx + dy * vy) / square, 0.0), AHEAD)
    return hypot(dx + ahead * vx, dy + ahead * vy)
