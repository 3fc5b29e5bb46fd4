"""The same game on coarser grids: how far off is the table?"""

from collections.abc import Callable
from dataclasses import dataclass
from math import log2, prod

import numpy as np

from ...core.errors import PlanError
from .relative_game import BoundGame
from .state_grid import Grid
from .value_solver import DiscretisationScheme, default_horizon, solve_bound
from .value_table import Array, Bound

Progress = Callable[[float], object]


@dataclass(frozen=True, slots=True)
class Refinement:
    """One grid beside the next finer one.

    Attributes:
        grid: The coarser grid.
        seconds: What it took to solve, in [s].
        mean: Mean distance of its values from the finer ones, in [m].
        most: What 95 % of them keep below, in [m].
        worst: The largest, in [m].
        above_mean: Share of its nodes that differ by more than the mean, in
            [1].
        order: Power of the spacing with which the mean falls, by this grid
            and the next coarser one; None for the coarsest.
    """

    grid: Grid
    seconds: float
    mean: float
    most: float
    worst: float
    above_mean: float
    order: float | None


def refine_bound(
    game: BoundGame,
    grid: Grid,
    levels: int = 1,
    *,
    horizon: float | None = None,
    scheme: DiscretisationScheme = DiscretisationScheme.WENO,
    progress: Progress | None = None,
) -> tuple[Bound, tuple[Refinement, ...]]:
    """Solve a game on a grid and on coarser ones.

    The mean difference to the grid of half as many cells is quoted as grid
    error: where the order is one or more, the finer table is no further off
    in the mean. It bounds no single value: :attr:`Refinement.above_mean`
    is the share of nodes that differ by more.

    Args:
        game: What the players can do.
        grid: The finest grid.
        levels: How many coarser ones, each of half as many cells.
        horizon: Duration of the game, in [s].
        scheme: How the equation is discretised.
        progress: Called with the share of the work done since the last call.

    Returns:
        The table on the finest grid, and the coarser ones from the coarsest
        on.

    Raises:
        PlanError: If a value is out of its range, or a grid too coarse.
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
        solved.append(
            solve_bound(game, g, horizon=horizon, scheme=scheme, progress=part)
        )
    rows: list[Refinement] = []
    for coarse, fine in zip(solved, solved[1:], strict=False):
        off = differences(coarse, fine)
        mean, most = float(off.mean()), float(np.quantile(off, 0.95))
        order = None
        if rows and mean > 0.0 and rows[-1].mean > 0.0:
            order = log2(rows[-1].mean / mean)
        worst = float(off.max())
        rows.append(
            Refinement(
                coarse.grid,
                coarse.seconds,
                mean,
                most,
                worst,
                float((off > mean).mean()),
                order,
            )
        )
    return solved[-1], tuple(rows)


def differences(coarse: Bound, fine: Bound) -> Array:
    """How far two tables are apart at the nodes of the first, in [m]."""
    a, r, psi = coarse.grid.axes()
    found = fine.value(r[:, None], a[:, None, None], psi)
    off: Array = np.abs(found - coarse.values)
    return off


def _scaled(
    progress: Progress, share: float, game: BoundGame, horizon: float | None
) -> Progress:
    whole = default_horizon(game) if horizon is None else horizon
    return lambda seconds: progress(share * seconds / whole)
