"""Marching the value backwards in time from the distance itself."""

from collections.abc import Callable, Iterator
from enum import StrEnum
from math import ceil, tau
from time import perf_counter
from typing import Any

import numpy as np

from ...core.errors import PlanError, check_positive
from ..unicycle.compilation import load_numba
from .compiled_stage import (
    FIFTH,
    FIRST,
    StageParameters,
    stage_blocks,
    wake_neighbours,
)
from .numpy_stage import stage_arrays
from .relative_game import BoundGame
from .state_grid import PAD, Grid, Values, fill_ghosts
from .value_table import Bound

MOST_STEPS = 1_000_000  # in time: more never end
COURANT = 0.75  # share of the largest stable step
SMOOTH = 1e-6  # square of a slope below which WENO sees no kink
STILL = 2e-3  # rate of the value that counts as none, in speeds
INNER = (slice(PAD, -PAD),) * 3


class DiscretisationScheme(StrEnum):
    """How the equation is discretised.

    ``WENO`` has slopes of fifth order, Godunov's flux and Runge-Kutta steps
    of third order; ``LAX`` has the local Lax-Friedrichs flux instead;
    ``FIRST`` and ``FIRST_LAX`` have slopes and steps of first order.
    """

    WENO = "weno"
    LAX = "lax"
    FIRST = "first"
    FIRST_LAX = "first-lax"

    @property
    def first_order(self) -> bool:
        """Whether slopes and steps are of first order."""
        return self in (
            DiscretisationScheme.FIRST,
            DiscretisationScheme.FIRST_LAX,
        )

    @property
    def godunov(self) -> bool:
        """Whether the flux is Godunov's."""
        return self in (DiscretisationScheme.WENO, DiscretisationScheme.FIRST)


def solve_bound(
    game: BoundGame,
    grid: Grid,
    *,
    horizon: float | None = None,
    scheme: DiscretisationScheme = DiscretisationScheme.WENO,
    double: bool = False,
    progress: Callable[[float], object] | None = None,
) -> Bound:
    """Compute the best least distance from every relative state.

    Args:
        game: What the players can do.
        grid: Where the value is computed.
        horizon: Duration of the game, in [s]; :func:`default_horizon` by
            default. What falls later shows in ``Bound.falling_mean``.
        scheme: How the equation is discretised.
        double: Whether to compute in double precision, half as fast.
        progress: Called with the seconds of the game done since the last
            call.

    Returns:
        The value as a table.

    Raises:
        PlanError: If a value is out of its range.
    """
    horizon = default_horizon(game) if horizon is None else horizon
    check_positive(horizon, "horizon", "s")
    begin, done = perf_counter(), 0.0
    late = values = None
    precision = np.float64 if double else np.float32
    for now, values in march(game, grid, horizon, scheme, precision):
        if progress is not None:
            progress(now - done)
        done = now
        if late is None and now >= 0.9 * horizon:
            late = values.copy()
    assert values is not None and late is not None  # a step at least
    falling = np.abs(values - late)
    return Bound(
        game,
        grid,
        values.copy(),
        horizon=horizon,
        scheme=scheme.value,
        falling_mean=float(falling.mean()),
        falling_worst=float(falling.max()),
        seconds=perf_counter() - begin,
    )


def default_horizon(game: BoundGame) -> float:
    """One turn at the slowest of the rates, in [s]."""
    return tau / game.rate


def march(
    game: BoundGame,
    grid: Grid,
    horizon: float,
    scheme: DiscretisationScheme,
    precision: type[Any] = np.float32,
) -> Iterator[tuple[float, Values]]:
    """Yield the time reached [s] and the values, step by step.

    Rows that no change can have reached are left alone. The values yielded
    are a view that the next step overwrites; shape (a, r, psi), in [m].
    """
    setting, rate = make_setting(game, grid, scheme, precision)
    stage = stage_blocks if load_numba() is not None else stage_arrays
    count = _count(horizon, rate)
    stable = precision(COURANT / rate)
    times = 1 if scheme.first_order else 3
    arm = 3 if setting.order == FIFTH else 1
    still = precision(STILL * game.evader_speed * float(stable))
    moved = np.ones(grid.shape[:2], bool)
    awake = np.empty_like(moved)
    v, w1, w2 = np.zeros((3, *(n + 2 * PAD for n in grid.shape)), precision)
    v[INNER] = setting.distance[:, None]

    def advance(
        first: Values, now: Values, out: Values, keep: float, last: bool
    ) -> None:
        fill_ghosts(now)
        stage(
            first, now, out, precision(keep), step, last, setting, awake,
            moved, still,
        )  # fmt: skip

    for n in range(1, count + 1):
        step = stable if n < count else precision(horizon - (n - 1) * stable)
        if wake_neighbours(moved, awake, arm, times):
            advance(v, v, w1, 0.0, times == 1)
            if times == 3:
                advance(v, w1, w2, 0.75, False)
                advance(v, w2, w1, 1.0 / 3.0, True)
            v, w1 = w1, v
        yield (n * float(stable) if n < count else horizon), v[INNER]


def count_steps(
    game: BoundGame,
    grid: Grid,
    horizon: float | None = None,
    scheme: DiscretisationScheme = DiscretisationScheme.WENO,
) -> int:
    """How many steps in time :func:`solve_bound` takes.

    Raises:
        PlanError: If it would not end, or a value is out of its range.
    """
    horizon = default_horizon(game) if horizon is None else horizon
    check_positive(horizon, "horizon", "s")
    return _count(horizon, make_setting(game, grid, scheme, np.float64)[1])


def _count(horizon: float, rate: float) -> int:
    count = max(1, ceil(horizon * rate / COURANT - 1e-6))
    if count > MOST_STEPS:
        raise PlanError(
            f"horizon must be at most {MOST_STEPS * COURANT / rate:g} [s] for "
            f"these speeds and rates on this grid, {MOST_STEPS} steps, or it "
            f"does not end, got {horizon:g}"
        )
    return count


def make_setting(
    game: BoundGame,
    grid: Grid,
    scheme: DiscretisationScheme,
    precision: type[Any],
) -> tuple[StageParameters, float]:
    """Put a game on a grid.

    Returns:
        What the loops need, and one over the largest stable step, in [1/s].
    """
    a, r, psi = grid.axes()
    steps = np.array(grid.spacings)
    forward = game.evader_speed * np.cos(psi)
    sideways = game.evader_speed * np.sin(psi)
    pursuer = np.stack(
        [
            game.pursuer_speed * np.cos(a),
            game.pursuer_speed * np.sin(a),
            game.pursuer_gain * a,
            np.full_like(a, game.pursuer_turn),
        ],
        axis=1,
    )
    ahead, across, turn, freedom = pursuer.T[:, :, None, None]
    # Each part is convex in 1/r, so the largest rate is at an end of r.
    swing = (across - sideways) / r[[0, -1], None]
    rate = np.abs(forward - ahead) / steps[0]
    rate = rate + (np.abs(swing - turn) + freedom) / steps[1]
    rate = rate + (np.abs(swing) + game.evader_turn) / steps[2]
    lengths = np.array([1.0, game.unit, game.unit])  # of a slope of one
    setting = StageParameters(
        pursuer.astype(precision),
        r.astype(precision),
        (1.0 / r).astype(precision),
        forward.astype(precision),
        sideways.astype(precision),
        precision(game.evader_turn),
        (1.0 / steps).astype(precision),
        (12.0 * SMOOTH * (lengths * steps) ** 2).astype(precision),
        FIRST if scheme.first_order else FIFTH,
        scheme.godunov,
    )
    return setting, float(rate.max())
