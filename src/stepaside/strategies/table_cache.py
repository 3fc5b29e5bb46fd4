"""Tables of games, solved at first use and kept in the cache folder."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import lru_cache
from hashlib import sha256
from typing import Any

import numpy as np

from ..core.atomic_output import atomic_draft
from ..core.compiled_cache import cache_folder
from ..core.poses import Array
from ..theory.value import CarGame, ValueTable, solve_cars
from ..theory.value.table import UNREADABLE

FAR = 4.5  # of the game against eqs. (1)-(2), in v/k
FORMAT = 8  # of the files


def cached(
    name: str, key: object, solve: Callable[[], Mapping[str, Array]]
) -> Mapping[str, Array]:
    """Return arrays from the cache folder by their key, or solve them."""
    digest = sha256(repr((FORMAT, key)).encode()).hexdigest()
    file = cache_folder() / f"{name}-{digest[:16]}.npz"
    try:
        with np.load(file) as saved:
            return dict(saved)
    except UNREADABLE:
        pass
    found: Mapping[str, Any] = solve()
    with (
        suppress(OSError),  # the cache only saves time
        atomic_draft(file) as draft,
        draft.open("wb") as out,
    ):
        np.savez_compressed(out, **found)
    return found


@lru_cache(maxsize=8)
def pursuit_bound(cells: int) -> ValueTable:
    """Load or solve the bound against (1)-(2), of unit speed and gain."""
    game = CarGame(1.0, 1.0, pursuer_gain=1.0)
    arrays = cached(
        "pursuit", cells, lambda: solve_cars(game, FAR, cells).arrays()
    )
    return ValueTable.from_arrays(arrays)
