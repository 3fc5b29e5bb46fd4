"""Grid refinement: error estimates from coarser grids."""

from collections.abc import Callable
from dataclasses import dataclass
from math import prod

import numpy as np

from ...core.errors import PlanError
from .relative_game import BoundGame
from .state_grid import Grid
from .value_solver import default_horizon, solve_bound
from .value_table import Array, Bound

Progress = Callable[[float], object]


@dataclass(frozen=True, slots=True)
class Refinement:
    """Differences between a grid and the next finer one.

    Attributes:
        grid: The coarser grid.
        seconds: Computing time of the coarser grid, in [s].
        mean: Mean absolute difference of the values, in [m].
        most: 95th percentile of the absolute differences, in [m].
        worst: Largest absolute difference, in [m].
        above_mean: Fraction of the nodes that differ by more than the mean,
            in [1].
    """

    grid: Grid
    seconds: float
    mean: float
    most: float
    worst: float
    above_mean: float


def refine_bound(
    game: BoundGame,
    grid: Grid,
    levels: int = 1,
    *,
    horizon: float | None = None,
    progress: Progress | None = None,
) -> tuple[Bound, tuple[Refinement, ...]]:
    """Solve a game on a grid and on coarser ones.

    The mean difference to the grid with half as many cells is reported as
    grid error: for orders of at least one, the mean error of the finer table
    is not larger. It is no bound of single values:
    :attr:`Refinement.above_mean` is the fraction of nodes that differ by
    more.

    Args:
        game: Speeds and turning limits of the players.
        grid: The finest grid.
        levels: Number of coarser grids, each with half as many cells.
        horizon: Duration of the game, in [s].
        progress: Called with the fraction of the work done since the last
            call.

    Returns:
        The table on the finest grid, and the refinements, coarsest first.

    Raises:
        PlanError: If a value is out of range, or a grid is too coarse.
    """
    if levels < 0:
        raise PlanError(f"refine must be >= 0 levels, got {levels}")
    grids = [grid]
    for _ in range(levels):
        grids.append(grids[-1].coarser())
    work = [prod(g.shape) ** (4 / 3) for g in grids]
    solved: list[Bound] = []
    for g, share in zip(reversed(grids), reversed(work), strict=True):
        part = None
        if progress is not None:
            part = _scaled(progress, share / sum(work), game, horizon)
        solved.append(solve_bound(game, g, horizon=horizon, progress=part))
    rows: list[Refinement] = []
    for coarse, fine in zip(solved, solved[1:], strict=False):
        errors = differences(coarse, fine)
        mean = float(errors.mean())
        rows.append(
            Refinement(
                coarse.grid,
                coarse.seconds,
                mean,
                float(np.quantile(errors, 0.95)),
                float(errors.max()),
                float((errors > mean).mean()),
            )
        )
    return solved[-1], tuple(rows)


def differences(coarse: Bound, fine: Bound) -> Array:
    """Return absolute differences at the nodes of the coarser table, [m]."""
    a, r, psi = coarse.grid.axes()
    values = fine.value(r[:, None], a[:, None, None], psi)
    errors: Array = np.abs(values - coarse.values)
    return errors


def _scaled(
    progress: Progress, share: float, game: BoundGame, horizon: float | None
) -> Progress:
    whole = default_horizon(game) if horizon is None else horizon
    return lambda seconds: progress(share * seconds / whole)
