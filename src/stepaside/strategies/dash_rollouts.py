"""Rollouts of straight dashes against behaviours of an opponent."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np

from ..core.compilation import compiled
from ..core.poses import Array, Pose, Sector, in_sectors, wrap_angles
from .velocity_set import BodyVelocity, VelocitySet, response_share

STEP = 0.1  # of a rollout, in [s]
STEERING_GAIN = 5.0  # of an opponent who steers at the robot, in [1/s]


class Dashes(NamedTuple):
    """Straight dashes, and standing.

    Attributes:
        angles: Direction of each in the map, in [rad]. Shape (n,).
        headings: Heading to which the body turns, in [rad]. Shape (n,).
        begins: Time at which each begins, in [s]; until then the robot
            stands. Infinite for standing. Shape (n,).
    """

    angles: Array
    headings: Array
    begins: Array


@dataclass(frozen=True, slots=True)
class Opponent:
    """Motion of an opponent at constant speed.

    Attributes:
        x: Position in the map, in [m].
        y: Likewise.
        course: Direction of motion in the map, in [rad].
        speed: Speed, in [m/s].
    """

    x: float
    y: float
    course: float
    speed: float


def make_dashes(
    count: int,
    pose: Pose,
    velocities: VelocitySet,
    later: float,
    *,
    both_ends: bool = False,
) -> Dashes:
    """Return standing, dashes that begin now, and those that begin later.

    The body turns the nearer end of its faster axis along the dash.

    Args:
        count: Number of directions.
        pose: Pose of the body in the map.
        velocities: Velocities that the legs deliver.
        later: Time after which the second set begins, in [s].
        both_ends: Whether to add dashes with the other end ahead.
    """
    angles = pose.theta + 2.0 * pi / count * np.arange(count)
    ahead = max(velocities.forward[1], -velocities.forward[0])
    aside = max(velocities.lateral[1], -velocities.lateral[0])
    along = angles if ahead >= aside else angles + 0.5 * pi
    turns = wrap_angles(along - pose.theta)
    turns = np.where(turns > 0.5 * pi, turns - pi, turns)
    turns = np.where(turns < -0.5 * pi, turns + pi, turns)
    if both_ends:
        angles = np.concatenate([angles, angles])
        turns = np.concatenate([turns, np.where(turns > 0.0, -pi, pi) + turns])
    headings = pose.theta + turns
    return Dashes(
        np.concatenate([[pose.theta], angles, angles]),
        np.concatenate([[pose.theta], headings, headings]),
        np.repeat([np.inf, 0.0, later], [1, angles.size, angles.size]),
    )


def greatest_velocities(angles: Array, velocities: VelocitySet) -> Array:
    """Return the fastest horizontal velocity in some directions of the body.

    Args:
        angles: Directions in the frame of the body, in [rad]. Any shape.
        velocities: Velocities that the legs deliver; an axis that they do not
            deliver is left out of the velocity.

    Returns:
        Components ahead and to the left, in [m/s]. Shape (2, *angles.shape).
    """
    parts = np.stack([np.cos(angles), np.sin(angles)])
    bounds = (velocities.forward, velocities.lateral)
    limits = np.stack(
        [
            np.where(part > 0.0, high, -low)
            for part, (low, high) in zip(parts, bounds, strict=True)
        ]
    )
    able = limits > 0.0
    relative = np.where(able, parts / np.where(able, limits, 1.0), 0.0)
    if not able.all():  # a unicycle walks at its component of the velocity
        return np.where(able, parts * limits, 0.0)
    found: Array = parts / np.hypot(*relative)
    return found


def roll_out(
    pose: Pose,
    velocity: BodyVelocity,
    dashes: Dashes,
    velocities: VelocitySet,
    horizon: float,
) -> Array:
    """Roll out dashes of legs with a lag.

    Each component of the velocity approaches that of the command with the
    time constant of its axis; the body turns at its greatest rate.

    Args:
        pose: Pose of the body in the map.
        velocity: Present velocity of the body.
        dashes: Dashes.
        velocities: Velocities that the legs deliver, and how fast.
        horizon: Duration, in [s].

    Returns:
        Positions in the map, the present one included, in [m]. Shape
        (steps + 1, n, 2).
    """
    count = round(horizon / STEP)
    times = STEP * np.arange(count, dtype=np.float64)[:, None]
    runs = times >= dashes.begins - 1e-9
    headings = headings_at(times, pose, dashes, velocities)
    commands = np.where(
        runs, greatest_velocities(dashes.angles - headings, velocities), 0.0
    )
    moved = np.empty((2, count, len(dashes.angles)))
    shares = [response_share(STEP, velocities.lags[i]) for i in range(2)]
    kernel = _compiled(_fill_responses)
    kernel(commands, np.array(velocity[:2]), np.array(shares), moved)
    cosine, sine = np.cos(headings), np.sin(headings)
    steps = STEP * np.stack(
        [
            cosine * moved[0] - sine * moved[1],
            sine * moved[0] + cosine * moved[1],
        ],
        axis=2,
    )
    start = np.broadcast_to([pose.x, pose.y], (1, len(dashes.angles), 2))
    return np.concatenate([start, start + np.cumsum(steps, axis=0)])


def headings_at(
    times: Array, pose: Pose, dashes: Dashes, velocities: VelocitySet
) -> Array:
    """Return the headings of the body during dashes, in [rad].

    Args:
        times: Times since now, in [s]. Shape (m, 1).
        pose: Pose of the body in the map.
        dashes: Dashes.
        velocities: Velocities that the legs deliver.

    Returns:
        Shape (m, n).
    """
    runs = times >= dashes.begins - 1e-9
    since = np.where(runs, times - dashes.begins, 0.0)
    turns = dashes.headings - pose.theta
    rate = np.where(turns > 0.0, velocities.turn[1], -velocities.turn[0])
    headings: Array = pose.theta + np.sign(turns) * np.minimum(
        np.abs(turns), rate * since
    )
    return headings


def unseen_shares(
    paths: Array,
    headings: Array,
    opponent: Opponent,
    views: Sequence[Sector],
) -> Array:
    """Return the share of time for which an opponent is out of view.

    The opponent keeps its course.

    Args:
        paths: Positions of the robot, in [m]. Shape (m, n, 2).
        headings: Its headings, in [rad]. Shape (m, n).
        opponent: Opponent at first.
        views: Bearings at which it is seen.

    Returns:
        Shape (n,).
    """
    way = STEP * opponent.speed * np.arange(len(paths))[:, None]
    x = opponent.x + way * cos(opponent.course) - paths[..., 0]
    y = opponent.y + way * sin(opponent.course) - paths[..., 1]
    seen = in_sectors(views, np.arctan2(y, x) - headings)
    shares: Array = np.mean(~seen, axis=0)
    return shares


def closest_approaches(
    paths: Array,
    opponent: Opponent,
    turning_radius: float,
    feints: Array,
    feint_duration: float,
) -> Array:
    """Return the worst closest approach of some paths.

    The opponent steers at the robot, limited by its turning radius, after
    turning fully to one side for a while.

    Args:
        paths: Positions of the robot, in [m]. Shape (steps + 1, n, 2).
        opponent: Opponent at first.
        turning_radius: Its smallest turning radius, in [m]; infinite for one
            who walks straight.
        feints: Sides to which it turns first: 1 left, -1 right, 0 none.
            Shape (m,).
        feint_duration: How long it does, in [s].

    Returns:
        Smallest distance over time and feints, in [m]. Shape (n,).
    """
    most = opponent.speed / turning_radius  # turning rate, [rad/s]
    place = opponent.x, opponent.y, opponent.course
    least = np.empty(paths.shape[1])
    _compiled(_fill_least_distances)(
        np.ascontiguousarray(paths),
        (*place, opponent.speed, most),
        feints,
        round(feint_duration / STEP),
        least,
    )
    return least


@cache
def _compiled(loop: Callable[..., None]) -> Callable[..., None]:
    """Return a loop, compiled if possible."""
    return compiled(loop)


def _fill_responses(
    commands: Array, velocity: Array, shares: Array, moved: Array
) -> None:
    """Write the velocities that follow commands with a lag.

    Args:
        commands: Velocities by axis, step and dash, in [m/s]. Shape (2,
            steps, n).
        velocity: Velocity before, in [m/s]. Shape (2,).
        shares: Share of a command that is reached in a step. Shape (2,).
        moved: Velocities after each step, in [m/s], written in place. Shape
            (2, steps, n).
    """
    for axis in range(2):
        for j in range(commands.shape[2]):
            now = velocity[axis]
            for i in range(commands.shape[1]):
                now += shares[axis] * (commands[axis, i, j] - now)
                moved[axis, i, j] = now


def _fill_least_distances(
    paths: Array,
    opponent: tuple[float, float, float, float, float],
    feints: Array,
    feint_steps: int,
    least: Array,
) -> None:
    """Write the smallest distance of each path over time and feints.

    Args:
        paths: Positions of the robot, in [m]. Shape (steps + 1, n, 2).
        opponent: Position [m], course [rad], speed [m/s] and greatest turning
            rate [rad/s] of the opponent.
        feints: Sides to which it turns first. Shape (m,).
        feint_steps: Number of steps for which it does.
        least: Distances, in [m], written in place. Shape (n,).
    """
    x0, y0, course0, speed, most = opponent
    way, sharp = STEP * speed, STEP * most
    # Up to this error, an opponent steers in proportion to it.
    slope = np.tan(min(most / STEERING_GAIN, 0.49 * pi))
    turn_c, turn_s = np.cos(sharp), np.sin(sharp)
    for j in range(paths.shape[1]):
        square = np.inf
        for side in feints:
            x, y, c, s = x0, y0, np.cos(course0), np.sin(course0)
            for i in range(paths.shape[0]):
                dx, dy = paths[i, j, 0] - x, paths[i, j, 1] - y
                square = min(square, dx * dx + dy * dy)
                if most > 0.0:
                    # Sine and cosine of the next turn.
                    sine, cosine = turn_s, turn_c
                    ahead, left = c * dx + s * dy, c * dy - s * dx
                    if side != 0.0 and i < feint_steps:
                        sine *= side
                    elif abs(left) < slope * ahead:
                        turn = STEP * STEERING_GAIN * np.arctan(left / ahead)
                        sine, cosine = np.sin(turn), np.cos(turn)
                    elif left < 0.0:
                        sine = -sine
                    c, s = c * cosine - s * sine, s * cosine + c * sine
                x += way * c
                y += way * s
        least[j] = np.sqrt(square)
