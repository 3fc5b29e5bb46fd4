"""Rollouts of straight dashes against behaviours of an opponent."""

from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

from ..core.poses import Array, Pose, wrap_angles
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
        turning_radius: Smallest turning radius, in [m]; infinite for one who
            walks straight.
    """

    x: float
    y: float
    course: float
    speed: float
    turning_radius: float


def make_dashes(
    count: int, pose: Pose, velocities: VelocitySet, later: float
) -> Dashes:
    """Return standing, dashes that begin now, and those that begin later.

    The body turns the nearer end of its faster axis along the dash.

    Args:
        count: Number of directions.
        pose: Pose of the body in the map.
        velocities: Velocities that the legs deliver.
        later: Time after which the second set begins, in [s].
    """
    angles = pose.theta + 2.0 * pi / count * np.arange(count)
    ahead = max(velocities.forward[1], -velocities.forward[0])
    aside = max(velocities.lateral[1], -velocities.lateral[0])
    along = angles if ahead >= aside else angles + 0.5 * pi
    turns = wrap_angles(along - pose.theta)
    turns = np.where(turns > 0.5 * pi, turns - pi, turns)
    turns = np.where(turns < -0.5 * pi, turns + pi, turns)
    headings = pose.theta + turns
    return Dashes(
        np.concatenate([[pose.theta], angles, angles]),
        np.concatenate([[pose.theta], headings, headings]),
        np.repeat([np.inf, 0.0, later], [1, count, count]),
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
    times = STEP * np.arange(count)[:, None]
    runs = times >= dashes.begins - 1e-9
    since = np.where(runs, times - dashes.begins, 0.0)
    turns = dashes.headings - pose.theta
    rate = np.where(turns > 0.0, velocities.turn[1], -velocities.turn[0])
    headings = pose.theta + np.sign(turns) * np.minimum(
        np.abs(turns), rate * since
    )
    commands = np.where(
        runs, greatest_velocities(dashes.angles - headings, velocities), 0.0
    )
    moved = np.empty((2, count, len(turns)))
    for axis in range(2):
        share = response_share(STEP, velocities.lags[axis])
        now = np.full(len(turns), velocity[axis])
        for i in range(count):
            now = now + share * (commands[axis, i] - now)
            moved[axis, i] = now
    cosine, sine = np.cos(headings), np.sin(headings)
    steps = STEP * np.stack(
        [
            cosine * moved[0] - sine * moved[1],
            sine * moved[0] + cosine * moved[1],
        ],
        axis=2,
    )
    start = np.broadcast_to([pose.x, pose.y], (1, len(turns), 2))
    return np.concatenate([start, start + np.cumsum(steps, axis=0)])


def closest_approaches(
    paths: Array, opponent: Opponent, feints: Array, feint_duration: float
) -> Array:
    """Return the worst closest approach of some paths.

    The opponent steers at the robot, limited by its turning radius, after
    turning fully to one side for a while.

    Args:
        paths: Positions of the robot, in [m]. Shape (steps + 1, n, 2).
        opponent: Opponent at first.
        feints: Sides to which it turns first: 1 left, -1 right, 0 none.
            Shape (m,).
        feint_duration: How long it does, in [s].

    Returns:
        Smallest distance over time and feints, in [m]. Shape (n,).
    """
    own_x, own_y = paths[..., 0][:, None], paths[..., 1][:, None]
    most = opponent.speed / opponent.turning_radius  # turning rate, [rad/s]
    sides = feints[:, None]
    shape = len(feints), paths.shape[1]
    x, y = np.full(shape, opponent.x), np.full(shape, opponent.y)
    course = np.full(shape, opponent.course)
    way = STEP * opponent.speed
    least = np.hypot(own_x[0] - x, own_y[0] - y)
    for i in range(len(paths) - 1):
        if most > 0.0:
            sight = np.arctan2(own_y[i] - y, own_x[i] - x)
            error = (sight - course + pi) % (2.0 * pi) - pi
            rate = np.clip(STEERING_GAIN * error, -most, most)
            if i * STEP < feint_duration:
                rate = np.where(sides != 0.0, sides * most, rate)
            course = course + STEP * rate
        x = x + way * np.cos(course)
        y = y + way * np.sin(course)
        distance = np.hypot(own_x[i + 1] - x, own_y[i + 1] - y)
        least = np.minimum(least, distance)
    found: Array = least.min(axis=0)
    return found
