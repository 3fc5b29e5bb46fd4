"""Tables of the bound: solved once, and kept for later."""

import os
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..core.errors import PlanError, StepAsideError
from .search.value_lookup import ValueTable

if TYPE_CHECKING:  # what solves takes Numba with it
    from ..theory.bound import Bound, BoundGame

NEAR, FAR = 0.15, 4.5  # of the game against eqs. (1)-(2), in v/k
CARS_NEAR, CARS_FAR = 0.5, 8.0  # of the two cars, in turning radii
FORMAT = 1


def cache_folder() -> Path:
    """Where tables are kept: the user's cache."""
    base = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    return Path(base).expanduser() / "stepaside"


def has_pursuit_bound(cells: int) -> bool:
    """Whether :func:`pursuit_bound` is kept, and need not be solved.

    Args:
        cells: Along each axis.
    """
    return _file_of("pursuit", cells).is_file()


@lru_cache(maxsize=8)
def pursuit_bound(cells: int) -> "Bound":
    """Best evader against eqs. (1)-(2), speeds and gains of one.

    Args:
        cells: Along each axis.
    """
    from ..theory.bound import against_pursuit

    return _kept("pursuit", against_pursuit(1.0, 1.0, 1.0), NEAR, FAR, cells)


@lru_cache(maxsize=8)
def cars_bound(cells: int) -> "Bound":
    """Both at their best: two identical cars, speed and turn of one."""
    from ..theory.bound import against_any

    return _kept(
        "cars", against_any(1.0, 1.0, 1.0), CARS_NEAR, CARS_FAR, cells
    )


@lru_cache(maxsize=8)
def pursuit_table(cells: int, unit: float) -> ValueTable:
    """Table of :func:`pursuit_bound` for compiled loops.

    Args:
        cells: Along each axis.
        unit: Speed over gain, in [m].
    """
    return value_table(pursuit_bound(cells), unit)


def value_table(bound: "Bound", unit: float) -> ValueTable:
    """Table of a bound that was solved in units.

    Args:
        bound: The bound.
        unit: Length of its unit of length, in [m].
    """
    whole = np.concatenate([bound.values[::-1, :, ::-1], bound.values])
    around = np.pad(whole, ((1, 1), (0, 0), (1, 1)), mode="wrap")
    return ValueTable(
        np.ascontiguousarray(around, dtype=np.float32),
        bound.grid.near,
        bound.grid.spacings[0],
        unit,
    )


def _kept(
    name: str, game: "BoundGame", near: float, far: float, cells: int
) -> "Bound":
    """Table from the cache, or solved and put there if that is possible."""
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
    """File in which a table is kept."""
    return cache_folder() / f"{name}-{cells}-{FORMAT}.npz"


def _try(write: Callable[[], object]) -> None:
    """Write what is only kept to save time; a full disk is no failure."""
    try:
        write()
    except (OSError, StepAsideError):
        return
