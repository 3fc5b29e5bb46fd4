"""Solver of the value, marching backwards in time from the distance."""

from collections.abc import Callable, Iterator
from math import ceil, tau
from time import perf_counter

import numpy as np

from ...core.errors import PlanError, check_positive
from .compiled_stage import (
    RowStates,
    StageParameters,
    mark_active_rows,
    stage_blocks,
)
from .relative_game import BoundGame
from .state_grid import PAD, Grid, Values, fill_ghosts
from .value_table import Bound

MAX_STEPS = 1_000_000  # in time
COURANT = 0.75  # fraction of the largest stable step
SMOOTH = 1e-6  # square of a slope that WENO treats as smooth
STILL = 2e-3  # rate of the value that counts as none, in evader speeds
INNER = (slice(PAD, -PAD),) * 3


def solve_bound(
    game: BoundGame,
    grid: Grid,
    *,
    horizon: float | None = None,
    progress: Callable[[float], object] | None = None,
) -> Bound:
    """Compute the value: the optimal closest approach of every state.

    Slopes are of fifth order, the flux is Godunov's, and steps are those of
    Runge and Kutta of third order.

    Args:
        game: Speeds and turning limits of the players.
        grid: Grid of relative states.
        horizon: Duration of the game, in [s]; :func:`default_horizon` by
            default. ``Bound.falling_mean`` measures the remaining decrease.
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
    for now, values in march(game, grid, horizon):
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
        falling_mean=float(falling.mean()),
        falling_worst=float(falling.max()),
        seconds=perf_counter() - begin,
    )


def default_horizon(game: BoundGame) -> float:
    """Return the time of one turn at the slowest rate, in [s]."""
    return tau / game.rate


def march(
    game: BoundGame, grid: Grid, horizon: float
) -> Iterator[tuple[float, Values]]:
    """Yield time [s] and values after every step.

    Rows that no change can have reached are skipped. The values are a view,
    shape (a, r, psi), in [m], that the next step overwrites.
    """
    setting, rate = make_stage_parameters(game, grid)
    count = _count(horizon, rate)
    stable = np.float32(COURANT / rate)
    still = np.float32(STILL * game.evader_speed * float(stable))
    changed = np.ones(grid.shape[:2], bool)
    rows = RowStates(np.empty_like(changed), changed, still)
    shape = 3, *(n + 2 * PAD for n in grid.shape)
    v, w1, w2 = np.zeros(shape, np.float32)
    v[INNER] = setting.distance[:, None]

    def advance(now: Values, out: Values, keep: float, last: bool) -> None:
        fill_ghosts(now)
        stage_blocks(v, now, out, np.float32(keep), step, last, setting, rows)

    for n in range(1, count + 1):
        step = stable if n < count else np.float32(horizon - (n - 1) * stable)
        if mark_active_rows(rows.changed, rows.active):
            advance(v, w1, 0.0, False)
            advance(w1, w2, 0.75, False)
            advance(w2, w1, 1.0 / 3.0, True)
            v, w1 = w1, v
        yield (n * float(stable) if n < count else horizon), v[INNER]


def count_steps(
    game: BoundGame, grid: Grid, horizon: float | None = None
) -> int:
    """Return the number of time steps of :func:`solve_bound`.

    Raises:
        PlanError: If there are too many, or a value is out of range.
    """
    horizon = default_horizon(game) if horizon is None else horizon
    check_positive(horizon, "horizon", "s")
    return _count(horizon, make_stage_parameters(game, grid)[1])


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
    game: BoundGame, grid: Grid
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
    smooth = 12.0 * SMOOTH * (lengths * steps) ** 2
    setting = StageParameters(
        pursuer.astype(np.float32),
        r.astype(np.float32),
        (1.0 / r).astype(np.float32),
        forward.astype(np.float32),
        sideways.astype(np.float32),
        np.float32(game.evader_turn),
        (1.0 / steps).astype(np.float32),
        smooth.astype(np.float32),
    )
    return setting, float(rate.max())
