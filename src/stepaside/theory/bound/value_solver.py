"""Solver of the value, marching backwards in time from the distance."""

from collections.abc import Callable, Iterator
from enum import StrEnum
from math import ceil, tau
from time import perf_counter
from typing import Any

import numpy as np

from ...core.compilation import load_numba
from ...core.errors import PlanError, check_positive
from .compiled_stage import (
    FIFTH,
    FIRST,
    RowStates,
    StageParameters,
    mark_active_rows,
    stage_blocks,
)
from .relative_game import BoundGame
from .state_grid import PAD, Grid, Values, fill_ghosts
from .upwind_scheme import lax_friedrichs, upwind, weno5
from .value_table import Bound

MAX_STEPS = 1_000_000  # in time
COURANT = 0.75  # fraction of the largest stable step
SMOOTH = 1e-6  # square of a slope that WENO treats as smooth
STILL = 2e-3  # rate of the value that counts as none, in evader speeds
INNER = (slice(PAD, -PAD),) * 3


class DiscretisationScheme(StrEnum):
    """Discretisation of the equation.

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
    """Compute the value: the optimal closest approach of every state.

    Args:
        game: Speeds and turning limits of the players.
        grid: Grid of relative states.
        horizon: Duration of the game, in [s]; :func:`default_horizon` by
            default. ``Bound.falling_mean`` measures the remaining decrease.
        scheme: Discretisation of the equation.
        double: Whether to compute in double precision, half as fast.
        progress: Called with the duration solved since the last call, in
            [s].

    Returns:
        Table of the value.

    Raises:
        PlanError: If a value is out of range.
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
    assert values is not None and late is not None  # at least one step
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
    """Return the time of one turn at the slowest rate, in [s]."""
    return tau / game.rate


def march(
    game: BoundGame,
    grid: Grid,
    horizon: float,
    scheme: DiscretisationScheme,
    precision: type[Any] = np.float32,
) -> Iterator[tuple[float, Values]]:
    """Yield time [s] and values after every step.

    Rows that no change can have reached are skipped. The values are a view,
    shape (a, r, psi), in [m], that the next step overwrites.
    """
    setting, rate = make_stage_parameters(game, grid, scheme, precision)
    stage = stage_blocks if load_numba() is not None else stage_arrays
    count = _count(horizon, rate)
    stable = precision(COURANT / rate)
    times = 1 if scheme.first_order else 3
    arm = 3 if setting.order == FIFTH else 1
    still = precision(STILL * game.evader_speed * float(stable))
    changed = np.ones(grid.shape[:2], bool)
    rows = RowStates(np.empty_like(changed), changed, still)
    v, w1, w2 = np.zeros((3, *(n + 2 * PAD for n in grid.shape)), precision)
    v[INNER] = setting.distance[:, None]

    def advance(
        first: Values, now: Values, out: Values, keep: float, last: bool
    ) -> None:
        fill_ghosts(now)
        stage(first, now, out, precision(keep), step, last, setting, rows)

    for n in range(1, count + 1):
        step = stable if n < count else precision(horizon - (n - 1) * stable)
        if mark_active_rows(rows.changed, rows.active, arm, times):
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
    """Return the number of time steps of :func:`solve_bound`.

    Raises:
        PlanError: If there are too many, or a value is out of range.
    """
    horizon = default_horizon(game) if horizon is None else horizon
    check_positive(horizon, "horizon", "s")
    return _count(
        horizon, make_stage_parameters(game, grid, scheme, np.float64)[1]
    )


def _count(horizon: float, rate: float) -> int:
    count = max(1, ceil(horizon * rate / COURANT - 1e-6))
    if count > MAX_STEPS:
        raise PlanError(
            f"horizon must be at most {MAX_STEPS * COURANT / rate:g} [s] for "
            f"these speeds and rates on this grid, {MAX_STEPS} steps, "
            f"got {horizon:g} [s]"
        )
    return count


def make_stage_parameters(
    game: BoundGame,
    grid: Grid,
    scheme: DiscretisationScheme,
    precision: type[Any],
) -> tuple[StageParameters, float]:
    """Compute the parameters of the stages.

    Returns:
        Parameters, and one over the largest stable step, in [1/s].
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
    # Each term is convex in 1/r, so the largest rate is at an end of r.
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


def stage_arrays(
    first: Any,
    now: Any,
    out: Any,
    keep: Any,
    step: Any,
    last: bool,
    setting: StageParameters,
    rows: RowStates,
) -> None:
    """Compute one stage in NumPy, without Numba.

    See :func:`.compiled_stage.stage_blocks`.
    """
    inner = (slice(3, -3),) * 3
    slopes: list[Any] = []
    for axis, number in ((1, 0), (0, 1), (2, 2)):
        a, b, c, d, e, f, g = (_shifted(now, axis, n) for n in range(-3, 4))
        if setting.order == FIFTH:
            pair = weno5(a, b, c, d, e, f, g, setting.smooth[number])
        else:
            pair = d - c, e - d
        slopes += [setting.scale[number] * slope for slope in pair]
    ahead, across, turn, freedom = setting.pursuer.T[:, :, None, None]
    rate = (upwind if setting.godunov else lax_friedrichs)(
        setting.forward - ahead,
        (across - setting.sideways) * setting.inverse[:, None],
        turn,
        freedom,
        setting.reach,
        tuple(slopes),
    )
    gain = np.float32(1.0) - keep
    made = keep * first[inner] + gain * (now[inner] + step * rate)
    if last:
        high = setting.distance[:, None]
        made = np.maximum(np.minimum(made, high), setting.distance[0])
        moved = (np.abs(made - first[inner]) > rows.still).any(axis=2)
        rows.changed[:] = rows.active & moved
    out[inner] = np.where(rows.active[:, :, None], made, first[inner])


def _shifted(v: Any, axis: int, by: int) -> Any:
    """Return the view without ghosts, shifted along one axis."""
    window = [slice(3, -3)] * 3
    end = v.shape[axis] - 3 + by
    window[axis] = slice(3 + by, end)
    return v[tuple(window)]
