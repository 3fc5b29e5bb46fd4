"""Evasion by straight dashes of legs that walk in any direction."""

from dataclasses import dataclass
from math import atan2, ceil, cos, hypot, inf, pi, sin
from typing import NamedTuple

import numpy as np

from ..core.poses import ALL_AROUND, Array, Pose, wrap_angle
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from .dash_rollouts import (
    STEP,
    Dashes,
    Opponent,
    closest_approaches,
    greatest_velocity,
    make_dashes,
    roll_out,
    unseen_shares,
)
from .knowledge import STAND, Intent, Knowledge, Limits
from .opponent_track import OpponentTrack
from .strategy import BackwardStrategy
from .velocity_set import STILL, BodyVelocity, VelocitySet, respond

DIRECTIONS = 24  # of dashes
HORIZON = 6.0  # of a rollout, in [s]
INTERVAL = 0.08  # between comparisons of a standing robot, in [s]
# Positions of the last 0.6 s at most every 0.03 s, which show a velocity
# once they span 0.3 s.
TRACK = OpponentTrack(0.4, span=1.5, spacing=0.075)
STILL_OPPONENT = 0.1  # speed below which it is expected to stand, in [m/s]
HEADING_GAIN = 3.0  # of turning the body along the dash, in [1/s]
LATER = 0.6  # after which the second set of dashes begins, in [s]
EFFORT = 0.05  # gain for which a robot begins to walk, or waits, in [m]
SURPLUS = 0.02  # value of clearance beyond what is enough, per metre
# Loss while the opponent is out of view all the time, in [m]: more than the
# two ends of one dash differ by on a T1, 0.1 m.
UNSEEN = 0.3
MOST = 100.0
POSITIVE = Range(0.0, 1e9, "m", "a length", above=True, also=(inf,))
NO_FEINT = np.zeros(1)
FEINTS = np.array([0.0, 1.0, -1.0])


class DashMemory(NamedTuple):
    """Memory of an evader that dashes."""

    track: OpponentTrack = TRACK  # last positions of the opponent
    time: float = 0.0  # time of the last decision [s]
    # own velocity at that time, by the response of the legs
    velocity: BodyVelocity = STILL
    command: BodyVelocity = STILL  # velocity that was desired since then
    # direction of the dash in the map [rad]; None while the robot stands
    angle: float | None = None
    compared: float = -inf  # time at which dashes were last compared [s]


@dataclass(frozen=True, slots=True)
class DashEvasion(BackwardStrategy, CheckedSettings):
    """Evader that takes the straight dash with the largest clearance.

    At each decision it rolls out standing, dashes in all directions, and the
    same dashes begun a little later, by velocity set and lag of its legs, and
    compares the closest approach of the opponent. The body turns its faster
    axis along the dash while it walks. Where the robot does not see all
    around, the other end of that axis may lead, so that the opponent stays in
    view.

    An opponent with infinite turning radius keeps its course. Another one
    steers at the robot, at once or after turning fully to either side, and
    the worst of these counts. With a doubt a dash is worth the closest
    approach of an opponent who keeps its course, and a share of that of one
    who steers: so the robot leaves the path to the side on which it also has
    room if the person turns. With an alertness it begins to compare dashes
    when the person could be near soon, even one who would pass.
    """

    turning_radius: float = setting(
        inf, "Assumed turning radius of the opponent", POSITIVE
    )
    enough: float = setting(
        1.2, "Closest approach beyond which no more is gained", POSITIVE
    )
    clearance: float = setting(
        0.8,
        "Closest approach at which a standing robot need not move",
        POSITIVE,
    )
    contact_time: float = setting(
        1.8,
        "A standing robot begins if the opponent could be nearer than the "
        "clearance within this time",
        Range(0.0, MOST, "s", "a time ahead", above=True),
    )
    effort: float = setting(
        EFFORT,
        "Gain for which a robot walks instead of standing",
        Range(0.0, MOST, "m", "a distance"),
    )
    change: float = setting(
        0.3,
        "Half the gain for which the opposite dash is better",
        Range(0.0, MOST, "m", "a distance"),
    )
    doubt: float = setting(
        inf,
        "Weight of an opponent who steers, relative to one who walks "
        "straight {unit}; inf for the former alone",
        Range(0.0, MOST, "1", "a share", also=(inf,)),
    )
    alertness: float = setting(
        0.0,
        "Time in which the opponent could be within the clearance, from "
        "which on dashes are compared",
        Range(0.0, MOST, "s", "a time ahead"),
    )

    def begin(self) -> DashMemory:
        """Return the memory before the first sighting."""
        # Compiles the rollouts now instead of at the first decision.
        still = VelocitySet((0.0, 1.0), (0.0, 1.0), (-1.0, 1.0))
        dashes = make_dashes(DIRECTIONS, 0.0, still, LATER)
        paths, _ = roll_out(Pose(0.0, 0.0, 0.0), STILL, dashes, still, 0.1)
        self._worth(paths, Opponent(1.0, 0.0, 0.0, 0.0), inf)
        return DashMemory()

    def decide(
        self, knowledge: Knowledge, memory: DashMemory
    ) -> tuple[Intent, DashMemory]:
        """Begin the dash with the largest worst-case closest approach."""
        limits, now = knowledge.limits, knowledge.time
        velocities = limits.velocities or _of_unicycle(limits)
        track = memory.track.note(
            now - knowledge.age, knowledge.position_in_map
        )
        opponent = extrapolate(track, now)
        pose = knowledge.step_start_in_map or knowledge.pose_in_map
        velocity = STILL
        if knowledge.moving:
            passed = max(0.0, now - memory.time)
            velocity = respond(
                memory.velocity, memory.command, velocities.lags, passed
            )
        stands = DashMemory(track, now, velocity, compared=memory.compared)
        if memory.angle is None:
            # A standing robot decides at every tick.
            waits = now - memory.compared < INTERVAL - 1e-9
            if waits or not self._is_near(pose, opponent):
                return STAND, stands
        looks = limits.views != ALL_AROUND
        dashes = make_dashes(
            DIRECTIONS, pose.theta, velocities, LATER, both_ends=looks
        )
        paths, headings = roll_out(pose, velocity, dashes, velocities, HORIZON)
        value = self._values(paths, opponent)
        value = value + self._bonus(dashes, memory.angle)
        if looks:
            soon = min(ceil(self.contact_time / STEP), len(headings))
            value -= UNSEEN * unseen_shares(
                paths[:soon], headings[:soon], opponent, limits.views
            )
        best = int(np.argmax(value))
        if dashes.begins[best] > 0.0:  # it is best to stand, at least for now
            return STAND, stands._replace(compared=now)
        angle = float(dashes.angles[best])
        turn = HEADING_GAIN * wrap_angle(
            float(dashes.headings[best]) - pose.theta
        )
        low, high = velocities.turn
        command = BodyVelocity(
            *greatest_velocity(angle - pose.theta, velocities),
            min(max(turn, low), high),
        )
        return Intent(velocity=command), DashMemory(
            track, now, velocity, command, angle, now
        )

    def _is_near(self, pose: Pose, opponent: Opponent) -> bool:
        """Return whether a standing robot has to compare dashes.

        A first test, cheap enough for every tick of a standing robot.
        """
        x, y = opponent.x - pose.x, opponent.y - pose.y
        distance, speed = hypot(x, y), opponent.speed
        alert = self.alertness * speed
        if alert > 0.0 and distance < self.clearance + alert:
            return True
        if distance > self.clearance + self.contact_time * speed:
            return False
        if self.turning_radius < inf and self.doubt == inf:
            return True
        u, v = cos(opponent.course), sin(opponent.course)
        along = -(x * u + y * v)
        return along > 0.0 and abs(x * v - y * u) < self.clearance

    def _bonus(self, dashes: Dashes, present: float | None) -> Array:
        """Return the value in [m] that prevents changes of little use.

        The present dash has an angle in [rad]; None while the robot stands.
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
        """Return the value of each dash along its path, in [m]. Shape (n,)."""
        radius = self.turning_radius
        steering = self._worth(paths, opponent, radius)
        if self.doubt == inf or radius == inf:
            return steering
        straight = self._worth(paths, opponent, inf)
        found: Array = (straight + self.doubt * steering) / (1.0 + self.doubt)
        return found

    def _worth(self, paths: Array, opponent: Opponent, radius: float) -> Array:
        """Return the value of each dash against one turning radius [m]."""
        feints = NO_FEINT if radius == inf else FEINTS
        least = closest_approaches(paths, opponent, float(radius), feints)
        value: Array = np.minimum(least, self.enough + SURPLUS * least)
        return value


def extrapolate(track: OpponentTrack, now: float) -> Opponent:
    """Return the opponent at a time, by a line through its positions."""
    last, velocity = track.rows[-1], track.velocity
    if velocity is None:
        return Opponent(last.x, last.y, 0.0, 0.0)
    u, v = velocity
    age, speed = now - last.time, hypot(u, v)
    return Opponent(
        last.x + age * u,
        last.y + age * v,
        atan2(v, u),
        speed if speed > STILL_OPPONENT else 0.0,
    )


def _of_unicycle(limits: Limits) -> VelocitySet:
    """Return the velocities of a unicycle."""
    speed, turn = limits.speed, pi * limits.gain
    return VelocitySet((-speed, speed), (0.0, 0.0), (-turn, turn))
