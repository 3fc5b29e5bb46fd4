"""One thing that moves, followed in the robot's own odometry."""

from collections import deque
from math import atan2, cos, exp, hypot, inf, sin, sqrt
from typing import NamedTuple

import numpy as np

from ..core.poses import Array

HOLD = 0.4  # how long a speed is believed unseen, in [s]
DECAY = 0.7  # time in which it is forgotten thereafter, in [s]
WINDOW = 5  # frames that are remembered for confirmation
ENOUGH = 3  # of them that must have found a thing
GATE = 16.0  # squared distance, in deviations, beyond which it is another
SHARP = 0.05  # deviation of a place that tells where a thing goes, in [m]
TRAIL = 1.2  # how long such places are kept, in [s]
APART = 0.1  # from one to the next, at least, in [s]
LEAST = 0.35  # that they must span to tell a velocity, in [s]
LAPSE = 0.3  # without a look, after which a new one begins, in [s]
HEARD = 0.2  # deviation across that only an ear has, in [m]
WALKED = 0.2  # way from where it was first seen sharply that is none, in [m]


class MotionModel(NamedTuple):
    """How things move that are followed.

    Attributes:
        push: Acceleration that they have, in [m/s^2].
        hurry: Speed that one may have when it is first seen, in [m/s].
    """

    push: float
    hurry: float


ANYBODY = MotionModel(1.0, 0.25)
WALKER = MotionModel(0.3, 0.1)  # a humanoid robot among things that rest


class Observation(NamedTuple):
    """Something seen at a place in odometry.

    Attributes:
        time: When it was seen, in [s].
        x: Where, in [m].
        y: Likewise.
        bearing: Direction from where it was seen, in [rad].
        along: Standard deviation along that direction, in [m].
        across: Standard deviation across it, in [m].
        identified: Whether it looks like the other robot.
        ranged: Whether its distance was measured too.
        height: How high it rises at least, in [m].
    """

    time: float
    x: float
    y: float
    bearing: float
    along: float
    across: float
    identified: bool
    ranged: bool
    height: float = 0.0

    @property
    def covariance(self) -> Array:
        """Covariance in odometry, in [m^2]. Shape (2, 2)."""
        c, s = cos(self.bearing), sin(self.bearing)
        turn = np.array([[c, -s], [s, c]])
        squares = np.array([self.along**2, self.across**2])
        covariance: Array = (turn * squares) @ turn.T
        return covariance


class TargetTrack:
    """Kalman filter of place and velocity, with a memory of its frames.

    Attributes:
        time: Time of the state, in [s].
        begun_at: When it was first seen, in [s].
        identified_at: When it last looked like the other robot, in [s].
        seen_at: When it was last seen, in [s].
        ranged_at: When its distance was last measured, in [s].
        sighted_at: When it was last seen and not only heard, in [s].
        watched_since: Since when it was seen without a gap, in [s].
        confirmed: Whether enough frames agree on it.
        height: How high it was seen to rise, in [m].
        walked: Whether it was seen to go anywhere.
        number: Tells it from others.
    """

    def __init__(
        self,
        first: Observation,
        number: int = 0,
        motion: MotionModel = ANYBODY,
    ) -> None:
        """Begin with a first observation."""
        self.number, self._push = number, motion.push
        self.walked = False
        self.sighted_at = -inf
        self._first: tuple[float, float] | None = None
        self._trail: deque[tuple[float, float, float]] = deque()
        self.time = self.seen_at = self.begun_at = first.time
        self.watched_since = first.time
        self.identified_at = first.time if first.identified else -inf
        self.ranged_at = first.time if first.ranged else -inf
        self.confirmed = False
        self.height = first.height
        self._state = np.array([first.x, first.y, 0.0, 0.0])
        self._covariance = np.zeros((4, 4))
        self._covariance[:2, :2] = first.covariance
        self._covariance[2, 2] = self._covariance[3, 3] = motion.hurry**2
        self._hits: deque[bool] = deque([True], maxlen=WINDOW)
        self._mark(first)

    @property
    def drift(self) -> tuple[float, float]:
        """Slope of the places seen sharply of late, in [m/s].

        It sways less than the velocity of the filter; zero until the places
        span a while.
        """
        trail = self._trail
        if not trail or trail[-1][0] - trail[0][0] < LEAST:
            return 0.0, 0.0
        times, x, y = np.array(trail).T
        late = times - times.mean()
        square = late @ late
        return float(late @ x / square), float(late @ y / square)

    def is_told(self, now: float) -> bool:
        """Whether it was seen sharply of late, and so how it moves.

        Args:
            now: Time, in [s].
        """
        trail = self._trail
        if not trail or now - trail[-1][0] > TRAIL:
            return False
        return trail[-1][0] - trail[0][0] >= LEAST

    def _mark(self, seen: Observation) -> None:
        """Keep a place that was seen sharply."""
        if seen.across < HEARD:
            self.sighted_at = max(self.sighted_at, seen.time)
        if not seen.ranged or max(seen.along, seen.across) > SHARP:
            return
        trail, here = self._trail, (seen.x, seen.y)
        while trail and seen.time - trail[0][0] > TRAIL:
            trail.popleft()
        if not trail or seen.time - trail[-1][0] >= APART:
            trail.append((seen.time, *here))
        self._first = self._first or here
        away = hypot(here[0] - self._first[0], here[1] - self._first[1])
        self.walked |= away > WALKED

    @property
    def velocity(self) -> tuple[float, float]:
        """Estimated velocity in odometry, in [m/s]."""
        return float(self._state[2]), float(self._state[3])

    def place_at(self, time: float) -> tuple[float, float]:
        """Predicted place in odometry, in [m]."""
        x, y, vx, vy = self._state.tolist()
        ahead, _ = _coast(time - self.time)
        return x + ahead * vx, y + ahead * vy

    def deviation_at(self, time: float) -> float:
        """Greatest standard deviation of the predicted place, in [m]."""
        (a, b), (_, d) = self._predicted(time)[1][:2, :2].tolist()
        return sqrt(0.5 * (a + d) + hypot(0.5 * (a - d), b))

    def misfit(self, seen: Observation) -> float:
        """Squared distance of an observation, in deviations."""
        state, covariance = self._predicted(max(seen.time, self.time))
        gap = self._moved(seen, state) - state[:2]
        spread = covariance[:2, :2] + seen.covariance
        return float(gap @ np.linalg.solve(spread, gap))

    def correct(self, seen: Observation) -> None:
        """Take an observation in, of any time."""
        self._state, self._covariance = self._predicted(
            max(seen.time, self.time)
        )
        measured = self._moved(seen, self._state)
        self.time = max(seen.time, self.time)
        spread = self._covariance[:2, :2] + seen.covariance
        gain = np.linalg.solve(spread, self._covariance[:2]).T
        self._state = self._state + gain @ (measured - self._state[:2])
        # Joseph's form stays positive.
        keep = np.eye(4)
        keep[:, :2] -= gain
        self._covariance = (
            keep @ self._covariance @ keep.T + gain @ seen.covariance @ gain.T
        )
        if seen.time - self.seen_at > LAPSE:
            self.watched_since = seen.time
        self.seen_at = max(self.seen_at, seen.time)
        if seen.identified:
            self.identified_at = max(self.identified_at, seen.time)
        if seen.ranged:
            self.ranged_at = max(self.ranged_at, seen.time)
        self.height = max(self.height, seen.height)
        self._mark(seen)

    def count(self, found: bool) -> None:
        """Note whether a frame that could have shown it did."""
        self._hits.append(found)
        if sum(self._hits) >= ENOUGH:
            self.confirmed = True

    def take_over(self, other: "TargetTrack") -> None:
        """Take over what is known of another track of the same thing."""
        self.identified_at = max(self.identified_at, other.identified_at)
        self.seen_at = max(self.seen_at, other.seen_at)
        self.ranged_at = max(self.ranged_at, other.ranged_at)
        self.confirmed = self.confirmed or other.confirmed
        self.height = max(self.height, other.height)
        self.walked |= other.walked
        self.sighted_at = max(self.sighted_at, other.sighted_at)

    @property
    def hopeless(self) -> bool:
        """Whether its frames will not confirm it any more."""
        misses = len(self._hits) - sum(self._hits)
        return not self.confirmed and misses > WINDOW - ENOUGH

    def turned_to(self, x: float, y: float, time: float) -> float:
        """Direction of the track from a place, in [rad]."""
        u, v = self.place_at(time)
        return atan2(v - y, u - x)

    def away_from(self, x: float, y: float, time: float) -> float:
        """Distance of the track from a place, in [m]."""
        u, v = self.place_at(time)
        return hypot(u - x, v - y)

    def _moved(self, seen: Observation, state: Array) -> Array:
        """Bring an old observation to the time of the state."""
        late = max(0.0, self.time - seen.time)
        return np.array([seen.x, seen.y]) + late * state[2:]

    def _predicted(self, time: float) -> tuple[Array, Array]:
        step = max(0.0, time - self.time)
        ahead, kept = _coast(step)
        move = np.diag([1.0, 1.0, kept, kept])
        move[0, 2] = move[1, 3] = ahead
        covariance = move @ self._covariance @ move.T
        push = self._push**2 * np.array(
            [[0.25 * step**4, 0.5 * step**3], [0.5 * step**3, step**2]]
        )
        # White noise within the step: it must not depend on how it is cut.
        push *= min(1.0, 0.3 / step) if step > 0.0 else 0.0
        covariance[0::2, 0::2] += push
        covariance[1::2, 1::2] += push
        return move @ self._state, covariance


def _coast(step: float) -> tuple[float, float]:
    """How far a unit speed leads unseen, in [s], and what is left of it.

    Walkers sway: the speed of an instant leads nowhere for long.
    """
    if step <= HOLD:
        return step, 1.0
    kept = exp(-(step - HOLD) / DECAY)
    return HOLD + DECAY * (1.0 - kept), kept
