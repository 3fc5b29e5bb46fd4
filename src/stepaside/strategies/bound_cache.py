"""Cached value tables of the bound, solved at first use."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..core.compilation import cache_folder
from ..core.errors import PlanError, StepAsideError
from .search.value_lookup import PursuitValues

if TYPE_CHECKING:  # the solver imports Numba
    from ..theory.bound import Bound, BoundGame

NEAR, FAR = 0.15, 4.5  # of the game against eqs. (1)-(2), in v/k
CARS_NEAR, CARS_FAR = 0.5, 8.0  # of the two cars, in turning radii
FORMAT = 1


def is_pursuit_bound_cached(cells: int) -> bool:
    """Return whether :func:`pursuit_bound` is cached.

    Args:
        cells: Number of cells along each axis.
    """
    return _file_of("pursuit", cells).is_file()


@lru_cache(maxsize=8)
def pursuit_bound(cells: int) -> "Bound":
    """Load or solve the bound against eqs. (1)-(2), with unit speed and gain.

    Args:
        cells: Number of cells along each axis.
    """
    from ..theory.bound import fixed_pursuit_game

    return _load_or_solve(
        "pursuit", fixed_pursuit_game(1.0, 1.0, 1.0), NEAR, FAR, cells
    )


@lru_cache(maxsize=8)
def cars_bound(cells: int) -> "Bound":
    """Load or solve the bound of two identical cars of unit speed and turn."""
    from ..theory.bound import two_car_game

    return _load_or_solve(
        "cars", two_car_game(1.0, 1.0, 1.0), CARS_NEAR, CARS_FAR, cells
    )


@lru_cache(maxsize=8)
def pursuit_table(cells: int, unit: float) -> PursuitValues:
    """Return the table of :func:`pursuit_bound` for compiled loops.

    Args:
        cells: Number of cells along each axis.
        unit: Length unit, speed over gain, in [m].
    """
    return value_table(pursuit_bound(cells), unit)


def value_table(bound: "Bound", unit: float) -> PursuitValues:
    """Return the table of a bound in scaled units.

    Args:
        bound: The bound.
        unit: Its length unit, in [m].
    """
    whole = np.concatenate([bound.values[::-1, :, ::-1], bound.values])
    around = np.pad(whole, ((1, 1), (0, 0), (1, 1)), mode="wrap")
    return PursuitValues(
        np.ascontiguousarray(around, dtype=np.float32),
        bound.grid.near,
        bound.grid.spacings[0],
        unit,
    )


def _load_or_solve(
    name: str, game: "BoundGame", near: float, far: float, cells: int
) -> "Bound":
    """Load a bound from the cache, or solve it and cache it if possible."""
    from ..theory.bound import Grid, load_bound, solve_bound

    grid = Grid.cube(near, far, cells)
    file = _file_of(name, cells)
    try:
        found = load_bound(file)
        if (found.game, found.grid) == (game, grid):
            return found
    except PlanError:
        pass
    solved = solve_bound(game, grid)
    _try(lambda: solved.save(file))
    return solved


def _file_of(name: str, cells: int) -> Path:
    """Return the path of a cached table."""
    return cache_folder() / f"{name}-{cells}-{FORMAT}.npz"


def _try(write: Callable[[], object]) -> None:
    """Write to the cache; it only saves time, so a full disk is no failure."""
    try:
        write()
    except (OSError, StepAsideError):
        return
