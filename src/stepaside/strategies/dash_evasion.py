"""Evasion by straight dashes of legs that walk in any direction."""

from dataclasses import dataclass
from math import atan2, cos, hypot, inf, pi, sin
from typing import NamedTuple

import numpy as np

from ..core.errors import (
    ConfigurationError,
    check_not_negative,
    check_positive,
    check_within,
)
from ..core.poses import ALL_AROUND, Array, Pose, Sector, wrap_angle
from .dash_rollouts import (
    STEP,
    Dashes,
    Opponent,
    closest_approaches,
    greatest_velocities,
    headings_at,
    make_dashes,
    roll_out,
    unseen_shares,
)
from .knowledge import STAND, Intent, Knowledge, Limits
from .strategy import BackwardStrategy
from .velocity_set import STILL, BodyVelocity, VelocitySet, respond

INTERVAL = 0.08  # between comparisons of a standing robot, in [s]
WINDOW = 0.6  # of the fit of the opponent's velocity, in [s]
SPACING = 0.03  # least time between sightings of the fit, in [s]
STILL_OPPONENT = 0.1  # speed below which it is expected to stand, in [m/s]
HEADING_GAIN = 3.0  # of turning the body along the dash, in [1/s]
LATER = 0.6  # after which the second set of dashes begins, in [s]
FEINT = 0.6  # time for which a chaser may turn away first, in [s]
EFFORT = 0.05  # gain for which a robot begins to walk, or waits, in [m]
SURPLUS = 0.02  # value of clearance beyond what is enough, per metre
CHANGE = 0.3  # half the gain for which the opposite dash is better, in [m]
# Loss while the opponent is out of view all the time, in [m]: more than the
# two ends of one dash differ by on a T1, 0.1 m.
UNSEEN = 0.3
CHASER_RADIUS = 2.5  # turning radius of a person who chases, in [m]
NO_FEINT = np.zeros(1)
FEINTS = np.array([0.0, 1.0, -1.0])


class TimedPosition(NamedTuple):
    """Position of the opponent at one time.

    Attributes:
        time: Time, in [s].
        x: Position in the map, in [m].
        y: Likewise.
    """

    time: float
    x: float
    y: float


class DashMemory(NamedTuple):
    """Memory of an evader that dashes.

    Attributes:
        trace: Last positions of the opponent, the oldest first.
        time: Time of the last decision, in [s].
        velocity: Own velocity at that time, by the response of the legs.
        command: Velocity that was desired since then.
        angle: Direction of the dash in the map, in [rad]; None while the
            robot stands.
        compared: Time at which dashes were last compared, in [s].
    """

    trace: tuple[TimedPosition, ...] = ()
    time: float = 0.0
    velocity: BodyVelocity = STILL
    command: BodyVelocity = STILL
    angle: float | None = None
    compared: float = -inf


@dataclass(frozen=True, slots=True)
class DashEvasion(BackwardStrategy):
    """Evader that takes the straight dash with the largest clearance.

    At each decision it rolls out standing, dashes in all directions, and the
    same dashes begun a little later, by velocity set and lag of its legs, and
    compares the closest approach of the opponent. The body turns its faster
    axis along the dash while it walks. Where the robot does not see all
    around, the other end of that axis may lead, so that the opponent stays in
    view.

    An opponent with infinite turning radius keeps its course. Another one
    steers at the robot, at once or after turning fully to either side, and
    the worst of these counts.

    Attributes:
        turning_radius: Assumed turning radius of the opponent, in [m].
        enough: Closest approach beyond which no more is gained, in [m].
        clearance: Closest approach at which a standing robot need not move,
            in [m].
        contact_time: A standing robot begins if the opponent could be nearer
            than the clearance within this time, in [s].
        horizon: Duration of a rollout, in [s].
        directions: Number of directions of dashes.
        effort: Gain for which a robot walks instead of standing, in [m].
        change: Half the gain for which the opposite dash is better, in [m].
    """

    turning_radius: float = inf
    enough: float = 1.2
    clearance: float = 0.8
    contact_time: float = 1.8
    horizon: float = 6.0
    directions: int = 24
    effort: float = EFFORT
    change: float = CHANGE

    def __post_init__(self) -> None:
        """Validate the settings."""
        error = ConfigurationError
        for name in ("turning_radius", "enough", "clearance"):
            if not getattr(self, name) > 0.0:
                raise error(
                    f"{name} must be > 0 [m], got {getattr(self, name)}"
                )
        check_positive(self.contact_time, "contact_time", "s", error)
        check_within(self.horizon, 0.5, 20.0, "horizon", "s", error)
        check_within(self.directions, 4, 360, "directions", "1", error)
        check_not_negative(self.effort, "effort", "m", error)
        check_not_negative(self.change, "change", "m", error)

    def begin(self) -> DashMemory:
        """Return the memory before the first sighting."""
        # Compiles the rollouts now instead of at the first decision.
        someone = Opponent(1.0, 0.0, 0.0, 0.0, self.turning_radius)
        still = VelocitySet((0.0, 1.0), (0.0, 1.0), (-1.0, 1.0))
        pose = Pose(0.0, 0.0, 0.0)
        dashes = make_dashes(self.directions, pose, still, LATER)
        paths = roll_out(pose, STILL, dashes, still, 0.1)
        closest_approaches(paths, someone, FEINTS, FEINT)
        return DashMemory()

    def decide(
        self, knowledge: Knowledge, memory: DashMemory
    ) -> tuple[Intent, DashMemory]:
        """Begin the dash with the largest worst-case closest approach."""
        velocities = knowledge.limits.velocities or _of_unicycle(
            knowledge.limits
        )
        now = knowledge.time
        trace = _note(memory.trace, knowledge)
        opponent = self._extrapolate(trace, now)
        pose = knowledge.step_start_in_map or knowledge.pose_in_map
        velocity = STILL
        if knowledge.moving:
            passed = max(0.0, now - memory.time)
            velocity = respond(
                memory.velocity, memory.command, velocities.lags, passed
            )
        stands = DashMemory(trace, now, velocity, compared=memory.compared)
        if memory.angle is None:
            # A standing robot decides at every tick.
            waits = now - memory.compared < INTERVAL - 1e-9
            if waits or not self._is_near(pose, opponent):
                return STAND, stands
        angle, heading = self._best(
            pose,
            velocity,
            velocities,
            opponent,
            memory.angle,
            knowledge.limits.views,
        )
        if angle is None:
            return STAND, stands._replace(compared=now)
        command = _dash_velocity(pose.theta, angle, heading, velocities)
        return Intent(velocity=command), DashMemory(
            trace, now, velocity, command, angle, now
        )

    def _is_near(self, pose: Pose, opponent: Opponent) -> bool:
        """Return whether a standing robot has to compare dashes.

        A first test, cheap enough for every tick of a standing robot.
        """
        x, y = opponent.x - pose.x, opponent.y - pose.y
        distance = hypot(x, y)
        if distance > self.clearance + self.contact_time * opponent.speed:
            return False
        if self.turning_radius < inf:
            return True
        u, v = cos(opponent.course), sin(opponent.course)
        along = -(x * u + y * v)
        return along > 0.0 and abs(x * v - y * u) < self.clearance

    def _best(
        self,
        pose: Pose,
        velocity: BodyVelocity,
        velocities: VelocitySet,
        opponent: Opponent,
        present: float | None,
        views: tuple[Sector, ...],
    ) -> tuple[float | None, float]:
        """Return angle and body heading of the best dash.

        Args:
            pose: Own pose in the map.
            velocity: Own velocity.
            velocities: Velocities that the legs deliver.
            opponent: The opponent.
            present: Angle of the present dash; None while the robot stands.
            views: Bearings at which the opponent is seen.

        Returns:
            Angle and heading in the map, in [rad]; no angle if it is best to
            stand, for now or all the time.
        """
        looks = views != ALL_AROUND
        dashes = make_dashes(
            self.directions, pose, velocities, LATER, both_ends=looks
        )
        paths = roll_out(pose, velocity, dashes, velocities, self.horizon)
        value = self._values(paths, opponent)
        value = value + self._bonus(dashes, present)
        if looks:
            times = np.arange(0.0, self.contact_time, STEP)[:, None]
            headings = headings_at(times, pose, dashes, velocities)
            value -= UNSEEN * unseen_shares(
                paths[: len(times)], headings, opponent, views
            )
        best = int(np.argmax(value))
        if dashes.begins[best] > 0.0:
            return None, pose.theta
        return float(dashes.angles[best]), float(dashes.headings[best])

    def _bonus(self, dashes: Dashes, present: float | None) -> Array:
        """Return the value in [m] that prevents changes of little use.

        Args:
            dashes: Dashes, and standing.
            present: Angle of the present dash; None while the robot stands.
        """
        begins = dashes.begins
        bonus: Array = np.where(np.isinf(begins), self.effort, 0.0)
        if present is None:
            return np.where(
                np.isinf(begins) | (begins == 0.0), bonus, 0.5 * self.effort
            )
        changes = self.change * (np.cos(dashes.angles - present) - 1.0)
        waits = np.where(begins > 0.0, EFFORT, 0.0)
        return np.where(np.isinf(begins), bonus, changes - waits)

    def _values(self, paths: Array, opponent: Opponent) -> Array:
        """Return the value of each dash, in [m]. Shape (n,).

        Args:
            paths: Positions along each dash. Shape (steps + 1, n, 2).
            opponent: The opponent.
        """
        straight = self.turning_radius == inf
        least = closest_approaches(
            paths, opponent, NO_FEINT if straight else FEINTS, FEINT
        )
        value: Array = np.minimum(least, self.enough + SURPLUS * least)
        return value

    def _extrapolate(
        self, trace: tuple[TimedPosition, ...], now: float
    ) -> Opponent:
        """Return the opponent at a time, by a line through its positions."""
        rows = np.array(trace)
        times = rows[:, 0] - now
        last = trace[-1]
        if times[-1] - times[0] < 0.5 * WINDOW:
            return Opponent(last.x, last.y, 0.0, 0.0, self.turning_radius)
        centred = times - times.mean()
        u, v = centred @ rows[:, 1:] / (centred @ centred)
        speed = hypot(u, v)
        age = -float(times[-1])
        return Opponent(
            last.x + age * u,
            last.y + age * v,
            atan2(v, u),
            speed if speed > STILL_OPPONENT else 0.0,
            self.turning_radius,
        )


def _note(
    trace: tuple[TimedPosition, ...], knowledge: Knowledge
) -> tuple[TimedPosition, ...]:
    """Add the position of the opponent, and forget old ones."""
    time = knowledge.time - knowledge.age
    pose = knowledge.pose_in_map
    sight = pose.theta + knowledge.bearing
    seen = TimedPosition(
        time,
        pose.x + knowledge.distance * cos(sight),
        pose.y + knowledge.distance * sin(sight),
    )
    kept = [each for each in trace if time - WINDOW <= each.time < time]
    # The newest is replaced if it is too close to the one before.
    if len(kept) > 1 and kept[-1].time - kept[-2].time < SPACING:
        kept.pop()
    return (*kept, seen)


def _dash_velocity(
    theta: float, angle: float, heading: float, velocities: VelocitySet
) -> BodyVelocity:
    """Return the velocity of a dash in the frame of the body.

    Args:
        theta: Heading of the body in the map, in [rad].
        angle: Direction of the dash in the map, in [rad].
        heading: Heading to which the body turns, in [rad].
        velocities: Velocities that the legs deliver.
    """
    ahead, left = greatest_velocities(np.array(angle - theta), velocities)
    low, high = velocities.turn
    turn = HEADING_GAIN * wrap_angle(heading - theta)
    return BodyVelocity(float(ahead), float(left), min(max(turn, low), high))


def _of_unicycle(limits: Limits) -> VelocitySet:
    """Return the velocities of a unicycle."""
    speed, turn = limits.speed, pi * limits.gain
    return VelocitySet((-speed, speed), (0.0, 0.0), (-turn, turn))
