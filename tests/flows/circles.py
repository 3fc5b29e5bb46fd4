"""The circle on which the game of equal players ends, by its formulas."""

from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

SPEED = 0.1  # [m/s], of the paper's humanoids
GAIN = 0.2  # [1/s]
STRIDE = 0.04  # [m]
STEP_TIME = 0.425 + 0.122  # [s], single and double support
PACE = STRIDE / STEP_TIME  # [m/s], over the floor


class Circle(NamedTuple):
    """What both players do in the end.

    Attributes:
        radius: Radius of both paths, in [m].
        distance: Distance between the players, in [m].
        headings: Angle between their headings, in [rad].
        offset: Angle at which the pursuer sees the evader, in [rad].
    """

    radius: float
    distance: float
    headings: float
    offset: float


def circle(
    angle: float = pi / 2,
    *,
    saturated: bool = False,
    speed: float = SPEED,
    gain: float = GAIN,
) -> Circle:
    """Both turn at one rate, and the line of sight with them.

    Args:
        angle: Evasion angle of the evader, in [rad].
        saturated: Whether the evader turns by eq. (6).
        speed: Speed of both, in [m/s].
        gain: Gain of both, in [1/s].
    """
    half = angle / 2
    if saturated:
        half = min(angle, 1.0)  # the evader turns at the gain, or slides
    radius = speed / (gain * half)
    return Circle(radius, 2 * radius * sin(half), pi - 2 * half, half)


def start_on(goal: Circle) -> tuple[float, float, float]:
    """Distance [m] and both offsets [rad] of players on their circle."""
    return goal.distance, -goal.offset, goal.offset


def arc(
    times: NDArray[np.float64],
    place: NDArray[np.float64],
    first: float,
    last: float,
) -> tuple[float, float]:
    """Radius of an arc by its chord and its turn, and the pace along it.

    Args:
        times: Times of the samples, in [s]. Shape (n,).
        place: x, y [m] and heading [rad]. Shape (n, 3).
        first: Time about which the arc begins, in [s].
        last: Time about which it ends, in [s].

    Returns:
        Radius, in [m], and pace, in [m/s]; positions are means over two
        steps.
    """
    begin, end = (
        place[abs(times - at) <= STEP_TIME].mean(axis=0)
        for at in (first, last)
    )
    chord = np.hypot(*(end - begin)[:2])
    turn = abs(end[2] - begin[2])
    radius = float(chord / (2 * sin(turn / 2)))
    return radius, radius * turn / (last - first)


def apart(
    pursuer: NDArray[np.float64], evader: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Distances of two players, in [m].

    Args:
        pursuer: x, y [m] first. Shape (n, 2 or 3).
        evader: Likewise.

    Returns:
        Shape (n,).
    """
    found: NDArray[np.float64] = np.hypot(*(pursuer - evader)[:, :2].T)
    return found


def closest_of_unicycles(
    start: tuple[float, float, float],
    duration: float,
    *,
    speed: float,
    gain: float,
    angle: float = pi / 2,
) -> float:
    """Closest approach by Runge's and Kutta's steps of the printed laws.

    Args:
        start: Distance [m], bearing of the evader from the pursuer and of
            the pursuer from the evader [rad].
        duration: Duration of the game, in [s].
        speed: Speed of both, in [m/s].
        gain: Gain of both, in [1/s].
        angle: Evasion angle, in [rad].

    Returns:
        Distance, in [m].
    """
    step = 0.005 / gain

    def rates(at: NDArray[np.float64]) -> NDArray[np.float64]:
        distance, aim, bearing = at
        side = -1.0 if bearing > 0 else 1.0
        sight = speed * (sin(aim) - sin(bearing)) / distance
        error = (bearing + side * angle + pi) % (2 * pi) - pi
        closing = speed * (cos(bearing) - cos(aim))
        return np.array([closing, sight - gain * aim, sight - gain * error])

    at = np.array(start)
    closest = at[0]
    for _ in range(round(duration / step)):
        k1 = rates(at)
        k2 = rates(at + 0.5 * step * k1)
        k3 = rates(at + 0.5 * step * k2)
        k4 = rates(at + step * k3)
        at = at + step / 6 * (k1 + 2 * (k2 + k3) + k4)
        closest = min(closest, at[0])
    return float(closest)
