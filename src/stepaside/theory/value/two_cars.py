r"""Games of two unicycles: any evader against any car, or eqs. (1)-(2).

An evader that walks backwards is a car that drives forwards along its
direction of motion. Poses are those of that direction in the pursuer's frame.
The pursuer turns by :math:`u_p = k a` (eq. (2)), with :math:`a` the bearing of
the evader, or by any :math:`|u_p| \le \omega_p`; the evader by
:math:`|u_e| \le \omega_e`. Each holds its turn for a period, the law excepted.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, pi, tau

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import (
    PlanError,
    check_not_negative,
    check_positive,
    check_within,
)
from ...core.poses import Array, wrap_angles
from .pose_grid import PoseGrid, sub_poses
from .solver import MOST, PursuerLaw, solve_game
from .table import ValueTable

BEARINGS = 64  # of either player, on a barrier
TURNS = 5  # of each car, evenly spaced
HELD = 0.5  # turn of the quicker car in a period, in [rad]
CELLS_HELD = 2.0  # that the distance changes by in a period, at least
STILL = 1e-3  # change in a period that counts as none, in units of length


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
        check_positive(self.pursuer_speed, "pursuer_speed", "m/s")
        check_positive(self.evader_speed, "evader_speed", "m/s")
        check_not_negative(self.pursuer_gain, "pursuer_gain", "1/s")
        check_not_negative(self.pursuer_turn, "pursuer_turn", "rad/s")
        turn = self.evader_turn or self.pursuer_turn or pi * self.pursuer_gain
        object.__setattr__(self, "evader_turn", turn)
        check_positive(turn, "evader_turn", "rad/s")
        if (self.pursuer_gain > 0.0) == (self.pursuer_turn > 0.0):
            raise PlanError(
                "pursuer_turn must be > 0 without pursuer_gain, else 0, got "
                f"{self.pursuer_turn:g} [rad/s]"
            )

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
        return _twists(self.evader_speed, self.evader_turn)

    @property
    def pursuer_twists(self) -> Array:
        """Those of a pursuer without a law. Shape (m, 3)."""
        return _twists(self.pursuer_speed, self.pursuer_turn)

    def period(self, spacing: float) -> float:
        """Return the time for which turns are held, in [s].

        Args:
            spacing: Spacing of the grid, in [m].
        """
        quickest = max(self.evader_turn, self.pursuer_turn)
        speed = self.pursuer_speed + self.evader_speed
        return max(HELD / quickest, CELLS_HELD * spacing / speed)

    def law(self, poses: Array, time: float) -> Array:
        """Return velocities of the pursuer by its law, held for a time in [s].

        Shape (n, 3), as the poses of the evader.
        """
        aim = np.arctan2(poses[:, 1], poses[:, 0])
        turn = aim * (1.0 - np.exp(-self.pursuer_gain * time)) / time
        speed = np.full_like(aim, self.pursuer_speed)
        return np.column_stack([speed, 0.0 * aim, turn])


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


def barrier(table: ValueTable, capture: float) -> Array:
    """Return the largest distances from which capture is possible, in [m].

    It is that at which the value crosses the capture distance, for each
    pair of bearings; the capture distance itself where the evader always
    escapes. Shape (32, 64).
    """
    spacing = table.grid.spacing
    far = table.grid.edge
    check_within(capture, 0.0, far, "capture", "m")
    r = np.arange(capture, far, 0.5 * spacing)
    angles = tau / BEARINGS * (np.arange(BEARINGS) + 0.5) - pi
    a, psi = angles[BEARINGS // 2 :, None, None], angles[:, None]
    values = table.value(car_poses(r, a, psi))
    captured = values < capture
    captured[..., 0] = True
    last = len(r) - 1 - captured[..., ::-1].argmax(axis=-1)
    after = np.minimum(last + 1, len(r) - 1)
    low, high = (
        np.take_along_axis(values, n[..., None], -1)[..., 0]
        for n in (last, after)
    )
    share = (capture - low) / np.maximum(high - low, 1e-12)
    reach = r[last] + np.clip(share, 0.0, 1.0) * (r[after] - r[last])
    distances: Array = np.maximum(reach, capture)
    return distances


def _twists(speed: float, turn: float) -> Array:
    """Return velocities with all turns that are tried."""
    rates = np.linspace(-turn, turn, TURNS)
    return np.column_stack([np.full(TURNS, speed), 0.0 * rates, rates])
