r"""Games of two unicycles: any evader against any car, or eqs. (1)-(2).

An evader that walks backwards is a car that drives forwards along its
direction of motion. Poses are those of that direction in the pursuer's frame.
The pursuer turns by :math:`u_p = k a` (eq. (2)), with :math:`a` the bearing of
the evader, or by any :math:`|u_p| \le \omega_p`; the evader by
:math:`|u_e| \le \omega_e`. Each holds its turn for a period, the law excepted.

The barrier of two identical cars is derived by following the characteristics
backwards in time from grazing capture; ``docs/bound.md`` has the derivation.
Its left half at one angle :math:`\theta` between the directions of motion is a
curve of three pieces:

1. both turn into the line of sight (pursuer left, evader right) until
   grazing capture at the bearing :math:`a_0 \in (0, \theta/2]`;
2. as 1 for some time, then the pursuer drives straight and the evader
   continues its turn until it is straight ahead;
3. as 2, but the pursuer first turns right, like the evader.

The right half is the mirror image of the left one at :math:`2\pi - \theta`.
States between both halves, up to their crossing, can be captured.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, pi, tau

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import PlanError, check_positive, check_within
from ...core.poses import Array, rotate, wrap_angles
from .outcomes import PoseGrid
from .table import (
    MOST,
    PursuerLaw,
    ValueTable,
    cached,
    solve_game,
    sub_poses,
    turning,
)

TURNS = 5  # of each car, evenly spaced
HELD = 0.5  # turn of the quicker car in a period, in [rad]
CELLS_HELD = 2.0  # that the distance changes by in a period, at least
STILL = 1e-3  # change in a period that counts as none, in units of length
POINTS = 60  # on each piece of a barrier
FAR = 4.5  # of the game against eqs. (1)-(2), in v/k
ANGLES = 18  # between the motions, over (0, pi], on a barrier


@dataclass(frozen=True, slots=True)
class CarGame:
    r"""Speeds and turning limits of the players.

    Attributes:
        pursuer_speed: Speed of the pursuer, in [m/s].
        evader_speed: Speed of the evader, in [m/s].
        pursuer_gain: Gain :math:`k` of the pursuer's law, in [1/s]; zero for
            a pursuer without a law.
        pursuer_turn: Largest turning rate :math:`\omega_p` of the pursuer, in
            [rad/s]; zero for one with a law.
        evader_turn: Largest turning rate of the evader, in [rad/s]; by
            default the pursuer's, :math:`k \pi` or :math:`\omega_p`.
    """

    pursuer_speed: float
    evader_speed: float
    pursuer_gain: float = 0.0
    pursuer_turn: float = 0.0
    evader_turn: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        turn = self.evader_turn or self.pursuer_turn or pi * self.pursuer_gain
        object.__setattr__(self, "evader_turn", turn)
        if not (self.pursuer_gain > 0.0) != (self.pursuer_turn > 0.0):
            raise PlanError(
                "one of pursuer_gain and pursuer_turn must be > 0, got "
                f"{self.pursuer_gain:g} [1/s], {self.pursuer_turn:g} [rad/s]"
            )
        check_positive(self.pursuer_speed, "pursuer_speed", "m/s")
        check_positive(self.evader_speed, "evader_speed", "m/s")
        check_positive(self.evader_turn, "evader_turn", "rad/s")

    @property
    def rate(self) -> float:
        """Slowest rate at which the game changes, in [1/s]."""
        return min(self.pursuer_gain or self.pursuer_turn, self.evader_turn)

    @property
    def unit(self) -> float:
        """Unit of length: speed of the evader over that rate, in [m]."""
        return self.evader_speed / self.rate

    @property
    def identical(self) -> bool:
        """Whether this is the game of two identical cars."""
        return (
            self.pursuer_speed == self.evader_speed
            and self.pursuer_turn == self.evader_turn
        )

    @property
    def evader_twists(self) -> Array:
        """Velocities of the evader that are tried. Shape (n, 3)."""
        return turning(self.evader_speed, self.evader_turn, TURNS)

    @property
    def pursuer_twists(self) -> Array:
        """Those of a pursuer without a law. Shape (m, 3)."""
        return turning(self.pursuer_speed, self.pursuer_turn, TURNS)

    def barrier(self, capture: float) -> Array | None:
        """Return poses on the barrier of a distance of capture, in [m].

        None if the cars are not identical. Shape (n, 3).
        """
        if not self.identical:
            return None
        poses, _ = barrier_poses(capture / self.unit)
        return poses * [self.unit, self.unit, 1.0]

    def period(self, spacing: float) -> float:
        """Return the time for which turns are held, in [s], on a grid [m]."""
        quickest = max(self.evader_turn, self.pursuer_turn)
        speed = self.pursuer_speed + self.evader_speed
        return max(HELD / quickest, CELLS_HELD * spacing / speed)


def solve_cars(
    game: CarGame,
    far: float,
    cells: int = 64,
    *,
    horizon: float | None = None,
    progress: Callable[[float], object] | None = None,
) -> ValueTable:
    """Compute the closest approach of a pursuer to an optimal evader.

    The barrier of two identical cars is off by 0.01 units at 40 cells in
    five units.

    Args:
        game: Speeds and turning limits of the players.
        far: Largest distance ahead in the table, in [m]; values beyond
            increase with the distance.
        cells: Cells in that distance, and number of headings.
        horizon: Duration of the game, in [s]; for ever by default.
        progress: Called with fractions of the work done since the last call.
    """
    check_positive(far, "far", "m")
    check_within(cells, 8, 400, "cells", "1")
    grid = PoseGrid.covering(far / cells, far, far, far, cells)
    period, periods = game.period(grid.spacing), MOST
    if horizon is not None:
        check_positive(horizon, "horizon", "s")
        periods = min(MOST, ceil(horizon / period))
        period = min(period, horizon / periods)
    answers: Array | PursuerLaw
    if game.pursuer_gain > 0.0:
        answers = PursuerLaw(game.pursuer_speed, game.pursuer_gain, period)
    else:
        answers = sub_poses(game.pursuer_twists, period)
    return solve_game(
        sub_poses(game.evader_twists, period),
        answers,
        grid,
        until=STILL * game.unit,
        periods=periods,
        progress=progress,
    )


@lru_cache(maxsize=8)
def pursuit_bound(cells: int) -> ValueTable:
    """Load or solve the bound against (1)-(2), of unit speed and gain."""
    game = CarGame(1.0, 1.0, pursuer_gain=1.0)
    arrays = cached(
        "pursuit", cells, lambda: solve_cars(game, FAR, cells).arrays()
    )
    return ValueTable.from_arrays(arrays)


def car_poses(
    distance: ArrayLike, error: ArrayLike, bearing: ArrayLike
) -> Array:
    r"""Return poses of the evader's motion from relative coordinates.

    Args:
        distance: Distance r, in [m]. All are broadcast.
        error: Bearing :math:`a` of the evader in the pursuer's frame, in
            [rad].
        bearing: Bearing :math:`\psi` of the pursuer in the frame of an evader
            that walks backwards, in [rad].
    """
    r, a, psi = np.broadcast_arrays(distance, error, bearing)
    return np.stack([r * np.cos(a), r * np.sin(a), wrap_angles(a - psi)], -1)


def turn_back(
    state: tuple[Array, Array, Array], pursuer: float, evader: float, t: Array
) -> tuple[Array, Array, Array]:
    """Integrate backwards in time from x, y and theta, in turning radii.

    Turning rates are -1, 0 or 1, the time ``t`` in units of one over them.
    """
    x, y, theta = state
    forward, aside = rotate(*_car_ago(evader, t), theta)
    back, left = _car_ago(pursuer, t)
    x, y = rotate(x + forward - back, y + aside - left, pursuer * t)
    return x, y, theta + (pursuer - evader) * t


def left_half(capture: float, theta: float) -> tuple[Array, Array]:
    """Compute the left half of the barrier at one angle between the motions.

    Args:
        capture: Distance of capture, in turning radii.
        theta: Direction of the evader's motion minus that of the pursuer's,
            in (0, 2 pi), in [rad].

    Returns:
        Points (x, y), in turning radii, shape (3 POINTS, 2), and the piece
        of each point, 1 to 3.
    """
    zero, one = np.zeros(POINTS), np.ones(POINTS)
    ago = np.linspace(0.0, theta / 2.0, POINTS)
    a = theta / 2.0 - ago
    grazing = capture * np.cos(a), capture * np.sin(a), 2.0 * a
    first = turn_back(grazing, 1.0, -1.0, ago)
    ahead = capture * one, zero, zero
    chase = np.linspace(0.0, theta, POINTS)
    straight = turn_back(ahead, 0.0, -1.0, chase)
    second = turn_back(straight, 1.0, -1.0, (theta - chase) / 2.0)
    whole = turn_back(ahead, 0.0, -1.0, theta * one)
    ago = np.linspace(0.0, tau - theta, POINTS)
    third = turn_back(whole, -1.0, -1.0, ago)
    points = [np.column_stack(p[:2]) for p in (first, second, third)]
    return np.concatenate(points), np.repeat([1, 2, 3], POINTS)


def barrier_slice(capture: float, theta: float) -> tuple[Array, Array]:
    """Compute the barrier at one angle: both halves up to their crossing.

    Arguments are those of :func:`left_half`.

    Returns:
        Points (x, y) from one end on the capture circle to the other, in
        turning radii, shape (n, 2), and their pieces, negative on the right.
    """
    left, pieces = left_half(capture, theta)
    right, others = left_half(capture, tau - theta)
    right = right * [1.0, -1.0]
    i, j, point = _first_crossing(left, right)
    points = np.concatenate([left[: i + 1], [point], right[j::-1]])
    numbers = np.concatenate([pieces[: i + 1], [pieces[i]], -others[j::-1]])
    return points, numbers


def barrier_poses(capture: float) -> tuple[Array, Array]:
    """Compute poses of the evader on the barrier of two identical cars.

    Angles between the motions are over (0, pi]; the rest follows by
    symmetry.

    Returns:
        Poses in the pursuer's frame, in turning radii and [rad], shape
        (n, 3), and their pieces; see :func:`barrier_slice`.
    """
    poses, numbers = [], []
    for theta in np.linspace(0.0, pi, ANGLES + 1)[1:].tolist():
        points, pieces = barrier_slice(capture, theta)
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
