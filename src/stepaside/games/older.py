"""Arrays of older run folders, as those of today would have them."""

from collections.abc import Sequence

import numpy as np

from ..core.poses import Array


def without_fillers(
    arrays: dict[str, Array], players: Sequence[str]
) -> dict[str, Array]:
    """Arrays of the first format that stand for something.

    Args:
        arrays: By name.
        players: Who played.
    """
    kept = {
        key: array
        for key, array in arrays.items()
        if not _is_filler(key, array)
    }
    for name in players:
        if f"{name}_qpos" not in kept:  # a person makes no footsteps of ours
            kept.pop(f"{name}_landings", None)
    return kept


def _is_filler(name: str, array: Array) -> bool:
    """Whether an array stands for what is not there."""
    optional = not name.endswith(("_com", "_torso", "times_s"))
    if not optional or array.dtype.kind != "f" or array.ndim != 2:
        return False
    if name.endswith("_qpos"):
        return bool(array.shape[1] == 0)
    return array.size > 0 and bool(np.isnan(array).all())
