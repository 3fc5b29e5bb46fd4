"""Kalman filter tracks of objects in odometry, and their tracker."""

from collections import deque
from collections.abc import Sequence
from itertools import count
from math import atan2, cos, exp, hypot, inf, sin, sqrt
from typing import NamedTuple

import numpy as np

from ..core.poses import Array

HOLD = 0.4  # prediction at constant velocity without observation, in [s]
DECAY = 0.7  # time constant of the velocity thereafter, in [s]
WINDOW = 5  # frames in which a track is confirmed
MIN_HITS = 3  # of them that must show it
GATE = 16.0  # largest squared Mahalanobis distance of an observation
MAX_DEVIATION = 0.05  # of a precise position, in [m]
TRAIL = 1.2  # how long precise positions are stored, in [s]
MIN_INTERVAL = 0.1  # between precise positions, in [s]
MIN_SPAN = 0.35  # of precise positions for a velocity, in [s]
MAX_GAP = 0.3  # without observation, after which a track is unsettled, in [s]
# Distance from the first precise position beyond which a track has walked, in
# [m]; the middle of a person at rest moves less than this.
MIN_WALK = 0.2


class MotionModel(NamedTuple):
    """Process noise of a track."""

    acceleration: float  # standard deviation of the acceleration [m/s^2]
    speed: float  # standard deviation of the first velocity [m/s]


PERSON_MOTION = MotionModel(1.0, 0.25)
ROBOT_MOTION = MotionModel(0.3, 0.1)  # a humanoid robot among things that rest


class Observation(NamedTuple):
    """Measured position of an object in odometry."""

    time: float  # time of the measurement [s]
    x_in_odometry: float  # [m]
    y_in_odometry: float  # position [m]
    bearing: float  # direction from the sensor in odometry [rad]
    along: float  # standard deviation along the bearing [m]
    across: float  # standard deviation across the bearing [m]
    identified: bool  # whether it has the appearance of the opponent
    ranged: bool  # whether its distance was measured
    height: float = 0.0  # observed height [m]; 0 if unknown

    @property
    def covariance(self) -> Array:
        """Covariance in odometry, in [m^2]. Shape (2, 2)."""
        c, s = cos(self.bearing), sin(self.bearing)
        turn = np.array([[c, -s], [s, c]])
        squares = np.array([self.along**2, self.across**2])
        covariance: Array = (turn * squares) @ turn.T
        return covariance


class TargetTrack:
    """Kalman filter of position and velocity, confirmed by several frames."""

    def __init__(
        self,
        first: Observation,
        number: int = 0,
        motion: MotionModel = PERSON_MOTION,
        velocity_in_odometry: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.number, self._acceleration = number, motion.acceleration
        self.has_walked = False
        self.watched_at = -inf
        self._first_position: tuple[float, float] | None = None
        self._trail: deque[tuple[float, float, float]] = deque()
        self.time = self.observed_at = self.started_at = first.time
        self.observed_since = first.time
        self.identified_at = first.time if first.identified else -inf
        self.confirmed = False
        self.height = first.height
        self._state = np.array(
            [first.x_in_odometry, first.y_in_odometry, *velocity_in_odometry]
        )
        self._covariance = np.zeros((4, 4))
        self._covariance[:2, :2] = first.covariance
        self._covariance[2, 2] = self._covariance[3, 3] = motion.speed**2
        self._hits: deque[bool] = deque([True], maxlen=WINDOW)
        self._store_position(first)

    @property
    def frames(self) -> tuple[bool, ...]:
        """Whether each of the last frames shows it, oldest first."""
        return tuple(self._hits)

    @property
    def drift(self) -> tuple[float, float]:
        """Velocity [m/s] by regression over recent precise positions.

        It sways less than that of the filter, and is zero at first.
        """
        trail = self._trail
        if not trail or trail[-1][0] - trail[0][0] < MIN_SPAN:
            return 0.0, 0.0
        times, x, y = np.array(trail).T
        delay = times - times.mean()
        square = delay @ delay
        return float(delay @ x / square), float(delay @ y / square)

    def has_velocity(self, now: float) -> bool:
        """Return whether recent precise positions give a velocity."""
        trail = self._trail
        if not trail or now - trail[-1][0] > TRAIL:
            return False
        return trail[-1][0] - trail[0][0] >= MIN_SPAN

    def is_watched(self, now: float) -> bool:
        """Return whether a camera on the torso has just shown it."""
        return now - self.watched_at <= MAX_GAP

    def _store_position(self, observation: Observation) -> None:
        """Store a precise position."""
        if (
            not observation.ranged
            or max(observation.along, observation.across) > MAX_DEVIATION
        ):
            return
        trail = self._trail
        position = observation.x_in_odometry, observation.y_in_odometry
        while trail and observation.time - trail[0][0] > TRAIL:
            trail.popleft()
        if not trail or observation.time - trail[-1][0] >= MIN_INTERVAL:
            trail.append((observation.time, *position))
        x, y = self._first_position = self._first_position or position
        walked = hypot(position[0] - x, position[1] - y)
        self.has_walked |= walked > MIN_WALK

    @property
    def velocity(self) -> tuple[float, float]:
        """Estimated velocity in odometry, in [m/s]."""
        return float(self._state[2]), float(self._state[3])

    def position_at(self, time: float) -> tuple[float, float]:
        """Return the predicted position in odometry, in [m]."""
        x, y, vx, vy = self._state.tolist()
        ahead, _ = _decay_velocity(time - self.time)
        return x + ahead * vx, y + ahead * vy

    def deviation_at(self, time: float) -> float:
        """Return the largest standard deviation of the prediction, in [m]."""
        (a, b), (_, d) = self._predicted(time)[1][:2, :2].tolist()
        return sqrt(0.5 * (a + d) + hypot(0.5 * (a - d), b))

    def mahalanobis_squared(self, observation: Observation) -> float:
        """Return the squared Mahalanobis distance of an observation."""
        state, covariance = self._predicted(max(observation.time, self.time))
        gap = self._extrapolated(observation, state) - state[:2]
        spread = covariance[:2, :2] + observation.covariance
        return float(gap @ np.linalg.solve(spread, gap))

    def update(self, observation: Observation) -> None:
        """Update the state with an observation, which may be delayed."""
        self._state, self._covariance = self._predicted(
            max(observation.time, self.time)
        )
        measured = self._extrapolated(observation, self._state)
        self.time = max(observation.time, self.time)
        spread = self._covariance[:2, :2] + observation.covariance
        gain = np.linalg.solve(spread, self._covariance[:2]).T
        self._state = self._state + gain @ (measured - self._state[:2])
        # The Joseph form keeps the covariance positive definite.
        complement = np.eye(4)
        complement[:, :2] -= gain
        self._covariance = (
            complement @ self._covariance @ complement.T
            + gain @ observation.covariance @ gain.T
        )
        if observation.time - self.observed_at > MAX_GAP:
            self.observed_since = observation.time
        self.observed_at = max(self.observed_at, observation.time)
        if observation.identified:
            self.identified_at = max(self.identified_at, observation.time)
        self.height = max(self.height, observation.height)
        self._store_position(observation)

    def record_frame(self, shown: bool) -> None:
        """Record whether a frame that should show the track does."""
        self._hits.append(shown)
        if sum(self._hits) >= MIN_HITS:
            self.confirmed = True

    def merge(self, other: "TargetTrack") -> None:
        """Merge the history of another track of the same object."""
        for name in (
            *("identified_at", "observed_at", "watched_at"),
            *("height", "confirmed", "has_walked"),
        ):
            setattr(self, name, max(getattr(self, name), getattr(other, name)))

    @property
    def is_rejected(self) -> bool:
        """Whether its frames can no longer confirm it."""
        misses = len(self._hits) - sum(self._hits)
        return not self.confirmed and misses > WINDOW - MIN_HITS

    def bearing_from(self, x: float, y: float, time: float) -> float:
        """Return its direction from a point in odometry, in [rad]."""
        u, v = self.position_at(time)
        return atan2(v - y, u - x)

    def distance_from(self, x: float, y: float, time: float) -> float:
        """Return its distance from a point in odometry, in [m]."""
        u, v = self.position_at(time)
        return hypot(u - x, v - y)

    def _extrapolated(self, observation: Observation, state: Array) -> Array:
        """Extrapolate a delayed observation to the time of the state."""
        delay = max(0.0, self.time - observation.time)
        return (
            np.array([observation.x_in_odometry, observation.y_in_odometry])
            + delay * state[2:]
        )

    def _predicted(self, time: float) -> tuple[Array, Array]:
        step = max(0.0, time - self.time)
        ahead, remaining = _decay_velocity(step)
        move = np.diag([1.0, 1.0, remaining, remaining])
        move[0, 2] = move[1, 3] = ahead
        covariance = move @ self._covariance @ move.T
        push = self._acceleration**2 * np.array(
            [[0.25 * step**4, 0.5 * step**3], [0.5 * step**3, step**2]]
        )
        # White noise: the result must not depend on the number of steps.
        push *= min(1.0, 0.3 / step) if step > 0.0 else 0.0
        covariance[0::2, 0::2] += push
        covariance[1::2, 1::2] += push
        return move @ self._state, covariance


def _decay_velocity(step: float) -> tuple[float, float]:
    """Return displacement [s] and remaining fraction of a unit speed.

    Walkers sway, so a velocity estimate predicts for a short time only.
    """
    if step <= HOLD:
        return step, 1.0
    remaining = exp(-(step - HOLD) / DECAY)
    return HOLD + DECAY * (1.0 - remaining), remaining


IDENTITY = 5.0  # how long a track stays recognised without trim, in [s]
MAX_AGE = 4.0  # of a confirmed track, in [s]
MAX_AGE_UNCONFIRMED = 1.0  # of any other track, in [s]
FRESH = 0.3  # age up to which a track is never dropped for its deviation
MAX_LAPSE = 0.5  # between the last observations of tracks of one object, [s]
MERGE_DISTANCE = 0.15  # of two tracks of one object, in [m]
TALL = 0.75  # height above which an object is no robot, in [m]
MERGE_DISTANCE_TALL = 0.35  # of two tracks of one person, in [m]
MAX_SPREAD = 0.6  # of the predicted position of a track, in [m]


class Tracker:
    """Multi-object tracker with nearest-neighbour association.

    Several frames confirm a track, so that one wrong frame does not make the
    robot move.
    """

    def __init__(self, motion: MotionModel = PERSON_MOTION) -> None:
        self._motion = motion
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
        for track in sorted(self.tracks, key=lambda t: -t.observed_at):
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
            return age < FRESH or track.deviation_at(now) < MAX_SPREAD

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
