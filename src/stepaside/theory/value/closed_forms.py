r"""Barriers of two games in closed form, in turning radii of the pursuer.

The homicidal chauffeur is that of Isaacs (Differential Games, 1965). The
barrier of two identical cars is derived by following the characteristics
backwards in time from grazing capture; ``docs/bound.md`` has the derivation.
With the evader at :math:`(x, y)` in the pursuer's frame and :math:`\theta`
between the directions of motion, the left half of the barrier at one
:math:`\theta` is a curve of three pieces:

1. both turn into the line of sight (pursuer left, evader right) until
   grazing capture at the bearing :math:`a_0 \in (0, \theta/2]`;
2. as 1 for some time, then the pursuer drives straight and the evader
   continues its turn until it is straight ahead;
3. as 2, but the pursuer first turns right, like the evader.

The right half is the mirror image of the left one at :math:`2\pi - \theta`.
States between both halves, up to their crossing, can be captured.
"""

from math import acos, asin, pi, sin, sqrt, tau

import numpy as np

from ...core.errors import PlanError, check_positive, check_within
from ...core.poses import Array, rotate

COUNT = 60  # points on each piece
PIECES = {1: "both turn in", 2: "straight last", 3: "same turn first"}


def guaranteed_distance(ratio: float) -> float:
    r"""Return the largest distance that a point can keep, in turning radii.

    Against the full turn of the car the evader runs straight along the
    normal of the capture circle. Both barriers close ahead of the car where
    they are tangential to its axis, which for a speed ratio :math:`\gamma`
    gives

    .. math::
        \sqrt{1 - \gamma^2} + \gamma \arcsin \gamma - 1
        \quad (\gamma \arcsin \gamma \le 1), \qquad
        \sqrt{1 + \gamma^2 - 2 \gamma \sin(1 / \gamma)}

    above, where the evader can circle with the car.
    """
    check_within(ratio, 1e-6, 1.0, "ratio", "1")
    if ratio * asin(ratio) <= 1.0:
        return sqrt(1.0 - ratio**2) + ratio * asin(ratio) - 1.0
    return sqrt(1.0 + ratio**2 - 2.0 * ratio * sin(1.0 / ratio))


def chauffeur_barrier(ratio: float, capture: float, count: int = 60) -> Array:
    """Return the left half of the barrier of a point with one speed.

    There is a closed form up to 0.897 of the speed of the car, and capture
    distances below the guaranteed one.

    Returns:
        Points (x, y) in the frame of the car, from the circle of capture to
        where both halves meet. Shape (count, 2).
    """
    if ratio * asin(min(ratio, 1.0)) > 1.0:
        raise PlanError(
            "the barrier is known for one speed in every direction, up to "
            f"0.897 of the pursuer's, got {ratio:g}"
        )
    check_within(capture, 0.0, guaranteed_distance(ratio), "capture", "radii")
    s = acos(ratio)

    def aside(t: Array) -> Array:
        side: Array = (capture - ratio * t) * np.sin(s + t) + 1.0 - np.cos(t)
        return side

    fine = np.linspace(0.0, asin(ratio), 20_000)
    end = fine[np.argmax(aside(fine) <= 0.0)] if capture > 0.0 else 0.0
    t = np.linspace(0.0, end, count)
    ahead = (capture - ratio * t) * np.cos(s + t) + np.sin(t)
    return np.column_stack([ahead, aside(t)])


def turn_back(
    state: tuple[Array, Array, Array], pursuer: float, evader: float, t: Array
) -> tuple[Array, Array, Array]:
    """Integrate backwards in time from x, y and theta, in turning radii.

    Turning rates are -1, 0 or 1, the time ``t`` in units of one over them.
    """
    x, y, theta = state
    forward, aside = _car_ago(evader, t)
    x = x + np.cos(theta) * forward - np.sin(theta) * aside
    y = y + np.sin(theta) * forward + np.cos(theta) * aside
    forward, aside = _car_ago(pursuer, t)
    x, y, heading = x - forward, y - aside, -pursuer * t
    x, y = rotate(x, y, -heading)
    return x, y, theta + (pursuer - evader) * t


def left_half(
    capture: float, theta: float, count: int = COUNT
) -> tuple[Array, Array]:
    """Compute the left half of the barrier at one angle between the motions.

    Args:
        capture: Distance of capture, in turning radii.
        theta: Direction of the evader's motion minus that of the pursuer's,
            in (0, 2 pi), in [rad].
        count: Points on each piece.

    Returns:
        Points (x, y), in turning radii, shape (3 count, 2), and the piece
        of each point, 1 to 3.
    """
    zero, one = np.zeros(count), np.ones(count)
    ago = np.linspace(0.0, theta / 2.0, count)
    a = theta / 2.0 - ago
    grazing = capture * np.cos(a), capture * np.sin(a), 2.0 * a
    first = turn_back(grazing, 1.0, -1.0, ago)
    ahead = capture * one, zero, zero
    chase = np.linspace(0.0, theta, count)
    straight = turn_back(ahead, 0.0, -1.0, chase)
    second = turn_back(straight, 1.0, -1.0, (theta - chase) / 2.0)
    whole = turn_back(ahead, 0.0, -1.0, theta * one)
    ago = np.linspace(0.0, tau - theta, count)
    third = turn_back(whole, -1.0, -1.0, ago)
    points = [np.column_stack(p[:2]) for p in (first, second, third)]
    return np.concatenate(points), np.repeat([1, 2, 3], count)


def barrier_slice(
    capture: float, theta: float, count: int = COUNT
) -> tuple[Array, Array]:
    """Compute the barrier at one angle: both halves up to their crossing.

    Arguments are those of :func:`left_half`.

    Returns:
        Points (x, y) from one end on the capture circle to the other, in
        turning radii, shape (n, 2), and their pieces, negative on the right.
    """
    left, pieces = left_half(capture, theta, count)
    right, others = left_half(capture, tau - theta, count)
    right = right * [1.0, -1.0]
    i, j, point = _first_crossing(left, right)
    points = np.concatenate([left[: i + 1], [point], right[j::-1]])
    numbers = np.concatenate([pieces[: i + 1], [pieces[i]], -others[j::-1]])
    return points, numbers


def barrier_poses(capture: float, angles: int = 18) -> tuple[Array, Array]:
    """Compute poses of the evader on the barrier of two identical cars.

    Angles between the motions are over (0, pi]; the rest follows by
    symmetry.

    Returns:
        Poses in the pursuer's frame, in turning radii and [rad], shape
        (n, 3), and their pieces; see :func:`barrier_slice`.
    """
    check_positive(capture, "capture", "radii")
    poses, numbers = [], []
    for theta in np.linspace(0.0, pi, angles + 1)[1:]:
        points, pieces = barrier_slice(capture, float(theta))
        poses.append(np.insert(points, 2, theta, axis=1))
        numbers.append(pieces)
    return np.concatenate(poses), np.concatenate(numbers)


def _car_ago(rate: float, t: Array) -> tuple[Array, Array]:
    """Return the earlier position of a car in its current frame."""
    if rate == 0.0:
        return -t, np.zeros_like(t)
    return -np.sin(rate * t) / rate, (1.0 - np.cos(rate * t)) / rate


def _first_crossing(first: Array, second: Array) -> tuple[int, int, Array]:
    """Return the segments of the first crossing of two polylines, and it."""
    p, d = first[:-1, None], np.diff(first, axis=0)[:, None]
    q, e = second[None, :-1], np.diff(second, axis=0)[None]
    w = q - p
    cross = d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (w[..., 0] * e[..., 1] - w[..., 1] * e[..., 0]) / cross
        t = (w[..., 0] * d[..., 1] - w[..., 1] * d[..., 0]) / cross
    hits = np.argwhere((s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0))
    if not len(hits):
        raise PlanError("the two halves of the barrier do not cross")
    i, j = (int(n) for n in hits[0])
    return i, j, first[i] + s[i, j] * (first[i + 1] - first[i])
