"""Rollouts of straight dashes against behaviours of an opponent."""

from collections.abc import Sequence
from math import cos, hypot, pi, sin
from typing import Any, NamedTuple

import numpy as np

from ..core.compilation import compiled, inlined
from ..core.poses import Array, Pose, Sector, in_sectors, wrap_angles
from .velocity_set import BodyVelocity, VelocitySet, response_share

STEP = 0.1  # of a rollout, in [s]
STEERING_GAIN = 5.0  # of an opponent who steers at the robot, in [1/s]
FEINT_STEPS = 6  # for which a chaser may turn away first


class Dashes(NamedTuple):
    """Straight dashes, and standing."""

    angles: Array  # direction of each in the map [rad]. (n,)
    headings: Array  # heading to which the body turns [rad]. (n,)
    # time at which each begins [s]; until then the robot stands. Infinite for
    # standing. (n,)
    begins: Array


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

    The body, at a heading in the map, turns the nearer end of its faster axis
    along the dash; both ends are tried if asked.
    """
    angles = theta + 2.0 * pi / count * np.arange(count)
    ahead, aside = (max(high, -low) for low, high in velocities[:2])
    turns = wrap_angles(angles - theta + (0.0 if ahead >= aside else pi / 2))
    turns = np.where(turns > 0.5 * pi, turns - pi, turns)
    turns = np.where(turns < -0.5 * pi, turns + pi, turns)
    if both_ends:
        angles = np.concatenate([angles, angles])
        turns = np.concatenate([turns, np.where(turns > 0.0, -pi, pi) + turns])
    headings = theta + turns
    return Dashes(
        np.concatenate([[theta], angles, angles]),
        np.concatenate([[theta], headings, headings]),
        np.repeat([np.inf, 0.0, later], [1, angles.size, angles.size]),
    )


@inlined
def greatest_velocity(angle: float, bounds: Any) -> tuple[float, float]:
    """Return the fastest velocity in a direction of the body, in [m/s].

    Components ahead and to the left, within a velocity set or its first two
    bounds; a unicycle walks at its component of the velocity.
    """
    c, s = cos(angle), sin(angle)
    ahead = bounds[0][1] if c > 0.0 else -bounds[0][0]
    left = bounds[1][1] if s > 0.0 else -bounds[1][0]
    if ahead > 0.0 and left > 0.0:
        speed = 1.0 / hypot(c / ahead, s / left)
        return speed * c, speed * s
    return c * max(ahead, 0.0), s * max(left, 0.0)


def roll_out(
    pose: Pose,
    velocity: BodyVelocity,
    dashes: Dashes,
    velocities: VelocitySet,
    horizon: float,
) -> tuple[Array, Array]:
    """Roll out dashes of legs with a lag until a horizon, in [s].

    Each component of the velocity approaches that of the command with the
    time constant of its axis; the body turns at its greatest rate. Returns
    positions in the map, the present one included, in [m], and headings, in
    [rad], in steps of 0.1 s. Shapes (steps + 1, n, 2), (steps, n).
    """
    steps, count = round(horizon / STEP), len(dashes.angles)
    paths, headings = np.empty((steps + 1, count, 2)), np.empty((steps, count))
    shares = [response_share(STEP, lag) for lag in velocities.lags[:2]]
    fill_paths(
        np.array(pose),
        np.array([*velocity[:2], *shares], dtype=np.float64),
        dashes,
        np.array(velocities[:3], dtype=np.float64),
        paths,
        headings,
    )
    return paths, headings


@compiled
def fill_paths(
    pose: Any, start: Any, dashes: Dashes, bounds: Any, paths: Any, out: Any
) -> None:
    """Write positions and headings of :func:`roll_out`.

    Start: velocity ahead and to the left, in [m/s], and share of a command
    that each reaches in a step. Bounds: ahead, to the left, and of turning,
    (3, 2).
    """
    for j in range(len(dashes.angles)):
        x, y, u, v = pose[0], pose[1], start[0], start[1]
        turn = dashes.headings[j] - pose[2]
        rate = bounds[2, 1] if turn > 0.0 else -bounds[2, 0]
        side = 1.0 if turn > 0.0 else -1.0
        paths[0, j, 0], paths[0, j, 1] = x, y
        for i in range(len(out)):
            since, heading = STEP * i - dashes.begins[j], pose[2]
            ahead = left = 0.0
            if since >= -1e-9:
                heading += side * min(abs(turn), rate * since)
                ahead, left = greatest_velocity(
                    dashes.angles[j] - heading, bounds
                )
            u += start[2] * (ahead - u)
            v += start[3] * (left - v)
            c, s = cos(heading), sin(heading)
            x += STEP * (c * u - s * v)
            y += STEP * (s * u + c * v)
            out[i, j] = heading
            paths[i + 1, j, 0], paths[i + 1, j, 1] = x, y


def unseen_shares(
    paths: Array,
    headings: Array,
    opponent: Opponent,
    views: Sequence[Sector],
) -> Array:
    """Return the share of time for which an opponent is out of view.

    The opponent keeps its course. Positions of the robot (m, n, 2), in [m],
    headings (m, n); the result has shape (n,).
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

    The opponent steers at the robot, limited by its turning radius (infinite
    for one who walks straight), after turning fully to a side for a while: 1
    left, -1 right, 0 none; the worst of these feints counts. Paths have shape
    (steps + 1, n, 2).
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
