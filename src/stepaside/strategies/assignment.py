"""Assignment of pursuers to evaders with the least total distance."""

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array


def assign(costs: Array) -> tuple[int, ...]:
    """Return the assignment of rows to columns with the least total cost.

    With more rows than columns every column is used, and none more than
    once more often than another.

    Args:
        costs: Cost of each pair. Shape (rows, columns).

    Returns:
        Column of each row.
    """
    rows, columns = costs.shape
    least = rows // columns  # uses of each column; some have one more
    slots = (least + 1) * columns
    square = np.zeros((slots, slots))  # rows below leave their slot unused
    square[:rows] = np.tile(costs, least + 1)
    square[rows:, : least * columns] = 1.0 + slots * np.abs(costs).max()
    return tuple((_permutation(square)[:rows] % columns).tolist())


def _permutation(costs: Array) -> NDArray[np.int64]:
    """Return the column of each row of a square by the Hungarian method."""
    size = len(costs)
    prices = np.zeros((2, size + 1))  # of rows and columns
    taken = np.full(size + 1, -1)  # row of each column; the last is a root
    for row in range(size):
        taken[size], column = row, size
        done = np.zeros(size + 1, bool)
        slack, origin = np.full(size, np.inf), np.full(size, size)
        while taken[column] >= 0:
            done[column], at = True, taken[column]
            reduced = costs[at] - prices[0, at] - prices[1, :size]
            nearer = ~done[:size] & (reduced < slack)
            slack[nearer], origin[nearer] = reduced[nearer], column
            column = int(np.where(done[:size], np.inf, slack).argmin())
            step = slack[column]
            prices[0, taken[done]] += step
            prices[1, done] -= step
            slack[~done[:size]] -= step
        while column < size:
            taken[column] = taken[origin[column]]
            column = origin[column]
    order: NDArray[np.int64] = np.argsort(taken[:size])
    return order
