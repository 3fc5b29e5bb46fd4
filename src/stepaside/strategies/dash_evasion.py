"""Evasion by straight dashes of legs that walk in any direction."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, ceil, cos, hypot, inf, pi, sin
from typing import Any, NamedTuple

import numpy as np

from ..core.compilation import compiled
from ..core.poses import (
    ALL_AROUND,
    Array,
    Pose,
    Sector,
    in_sectors,
    wrap_angle,
    wrap_angles,
)
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from .knowledge import STAND, Intent, Knowledge
from .opponent_track import OpponentTrack
from .strategy import BackwardStrategy
from .velocity_set import (
    STILL,
    BodyVelocity,
    VelocitySet,
    greatest_velocity,
    respond,
    response_share,
)

STEP = 0.1  # of a rollout, in [s]
STEERING_GAIN = 5.0  # of an opponent who steers at the robot, in [1/s]
FEINT_STEPS = 6  # for which a chaser may turn away first


class Dashes(NamedTuple):
    """Straight dashes, and standing: n of them."""

    angles: Array  # direction in the map [rad]
    headings: Array  # to which the body turns [rad]
    begins: Array  # [s]; until then the robot stands, for ever if infinite


class Opponent(NamedTuple):
    """Motion of an opponent at constant speed."""

    x: float  # position in the map [m]
    y: float  # likewise
    course: float  # direction of motion in the map [rad]
    speed: float  # speed [m/s]


def make_dashes(
    count: int,
    theta: float,
    velocities: VelocitySet,
    later: float,
    *,
    both_ends: bool = False,
) -> Dashes:
    """Return standing, dashes that begin now, and those that begin later.

    The nearer end of the body's faster axis leads, or each if asked.
    """
    angles = theta + 2.0 * pi / count * np.arange(count)
    ahead, aside = (max(high, -low) for low, high in velocities[:2])
    turns = wrap_angles(angles - theta + (0.0 if ahead >= aside else pi / 2))
    turns -= pi * np.round(turns / pi)
    if both_ends:
        angles = np.concatenate([angles, angles])
        turns = np.concatenate([turns, np.where(turns > 0.0, -pi, pi) + turns])
    headings = theta + turns
    return Dashes(
        np.concatenate([[theta], angles, angles]),
        np.concatenate([[theta], headings, headings]),
        np.repeat([np.inf, 0.0, later], [1, angles.size, angles.size]),
    )


@compiled
def roll_out(
    pose: Any, velocity: Any, dashes: Dashes, legs: VelocitySet, steps: int
) -> tuple[Any, Any]:
    """Roll out dashes of legs with a lag, in steps of 0.1 s.

    Each component of the velocity approaches that of the command with the
    time constant of its axis; the body turns at its greatest rate. Returns
    positions in the map, the present one included, in [m], and headings, in
    [rad]. Shapes (steps + 1, n, 2), (steps, n).
    """
    count = len(dashes.angles)
    paths, headings = np.empty((steps + 1, count, 2)), np.empty((steps, count))
    follows = response_share(STEP, legs.lags[0])
    follows_aside = response_share(STEP, legs.lags[1])
    for j in range(count):
        x, y, u, v = pose[0], pose[1], velocity[0], velocity[1]
        turn = dashes.headings[j] - pose[2]
        rate = legs.turn[1] if turn > 0.0 else -legs.turn[0]
        side = 1.0 if turn > 0.0 else -1.0
        paths[0, j, 0], paths[0, j, 1] = x, y
        for i in range(steps):
            since, heading = STEP * i - dashes.begins[j], pose[2]
            ahead = left = 0.0
            if since >= -1e-9:
                heading += side * min(abs(turn), rate * since)
                ahead, left = greatest_velocity(
                    dashes.angles[j] - heading, legs
                )
            u += follows * (ahead - u)
            v += follows_aside * (left - v)
            c, s = cos(heading), sin(heading)
            x += STEP * (c * u - s * v)
            y += STEP * (s * u + c * v)
            headings[i, j] = heading
            paths[i + 1, j, 0], paths[i + 1, j, 1] = x, y
    return paths, headings


def unseen_shares(
    paths: Array,
    headings: Array,
    opponent: Opponent,
    views: Sequence[Sector],
) -> Array:
    """Return the share of time for which an opponent is out of view. (n,).

    The opponent keeps its course; positions (m, n, 2) and headings (m, n) are
    those of the robot.
    """
    way = STEP * opponent.speed * np.arange(len(paths))[:, None]
    x = opponent.x + way * cos(opponent.course) - paths[..., 0]
    y = opponent.y + way * sin(opponent.course) - paths[..., 1]
    seen = in_sectors(views, np.arctan2(y, x) - headings)
    shares: Array = np.mean(~seen, axis=0)
    return shares


@compiled
def closest_approaches(
    paths: Any, opponent: Opponent, turning_radius: float, feints: Any
) -> Any:
    """Return the worst closest approach of some paths, in [m]. Shape (n,).

    The opponent steers at the robot, limited by its turning radius, after one
    of several feints: turning fully to a side for a while, 1 left, -1 right,
    0 none.
    """
    most = opponent.speed / turning_radius  # turning rate, [rad/s]
    way, sharp = STEP * opponent.speed, STEP * most
    # Up to this error, an opponent steers in proportion to it.
    slope = np.tan(min(most / STEERING_GAIN, 0.49 * pi))
    turn_c, turn_s = cos(sharp), sin(sharp)
    least = np.empty(paths.shape[1])
    for j in range(paths.shape[1]):
        square = np.inf
        for side in feints:
            x, y = opponent.x, opponent.y
            c, s = cos(opponent.course), sin(opponent.course)
            for i in range(paths.shape[0]):
                dx, dy = paths[i, j, 0] - x, paths[i, j, 1] - y
                square = min(square, dx * dx + dy * dy)
                if most > 0.0:
                    # Sine and cosine of the next turn.
                    sine, cosine = turn_s, turn_c
                    ahead, left = c * dx + s * dy, c * dy - s * dx
                    if side != 0.0 and i < FEINT_STEPS:
                        sine *= side
                    elif abs(left) < slope * ahead:
                        turn = STEP * STEERING_GAIN * np.arctan(left / ahead)
                        sine, cosine = sin(turn), cos(turn)
                    elif left < 0.0:
                        sine = -sine
                    c, s = c * cosine - s * sine, s * cosine + c * sine
                x += way * c
                y += way * s
        least[j] = np.sqrt(square)
    return least


DIRECTIONS = 24  # of dashes
STEPS = 60  # of a rollout
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
TIME = Range(0.0, MOST, "s", "a time ahead")
GAIN = Range(0.0, MOST, "m", "a distance")
NO_FEINT = np.zeros(1)
FEINTS = np.array([0.0, 1.0, -1.0])


class DashMemory(NamedTuple):
    """Memory of an evader that dashes."""

    track: OpponentTrack = TRACK
    time: float = 0.0  # of the last decision [s]
    velocity: BodyVelocity = STILL  # own, then, by the response of the legs
    command: BodyVelocity = STILL  # velocity that was desired since then
    angle: float | None = None  # of the dash in the map [rad]; None: stands
    compared: float = -inf  # time at which dashes were last compared [s]


@dataclass(frozen=True, slots=True)
class DashEvasion(BackwardStrategy, CheckedSettings):
    """Evader that takes the straight dash with the largest clearance.

    It compares standing and dashes in all directions, begun now or a little
    later, by the closest approach of the opponent. The body turns its faster
    axis along the dash; where the robot does not see all around, either end
    of that axis may lead, so that the opponent stays in view.

    An opponent with infinite turning radius keeps its course. Another one
    steers at the robot, at once or after turning fully to either side, and
    the worst of these counts. With a doubt, that is worth only a share beside
    an opponent who keeps its course: so the robot leaves the path to the side
    on which it also has room if the person turns.
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
        EFFORT, "Gain for which a robot walks instead of standing", GAIN
    )
    change: float = setting(
        0.3, "Half the gain for which the opposite dash is better", GAIN
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
        TIME,
    )

    def begin(self) -> DashMemory:
        """Return the memory before the first sighting."""
        # Compiles the rollouts now instead of at the first decision.
        still = VelocitySet((0.0, 1.0), (0.0, 1.0), (-1.0, 1.0))
        dashes = make_dashes(DIRECTIONS, 0.0, still, LATER)
        paths, _ = roll_out(Pose(0.0, 0.0, 0.0), STILL, dashes, still, 1)
        self._worth(paths, Opponent(1.0, 0.0, 0.0, 0.0), inf)
        return DashMemory()

    def decide(
        self, knowledge: Knowledge, memory: DashMemory
    ) -> tuple[Intent, DashMemory]:
        """Begin the dash with the largest worst-case closest approach."""
        limits, now = knowledge.limits, knowledge.time
        speed, rate = limits.speed, pi * limits.gain
        velocities = limits.velocities or VelocitySet(
            (-speed, speed), (0.0, 0.0), (-rate, rate)
        )
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
        paths, headings = roll_out(pose, velocity, dashes, velocities, STEPS)
        value = self._worth(paths, opponent, self.turning_radius)
        if self.doubt < inf and self.turning_radius < inf:
            straight = self._worth(paths, opponent, inf)
            value = (straight + self.doubt * value) / (1.0 + self.doubt)
        value += self._bonus(dashes, memory.angle)
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
        """Return whether a standing robot has to compare dashes."""
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
        """Return the value in [m] that prevents changes from the present."""
        waits = dashes.begins > 0.0
        if present is None:
            found = np.where(waits, 0.5 * self.effort, 0.0)
        else:
            found = self.change * (np.cos(dashes.angles - present) - 1.0)
            found[waits] -= EFFORT
        found[np.isinf(dashes.begins)] = self.effort
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
