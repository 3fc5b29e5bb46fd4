"""Assignment of pursuers to evaders with the least total distance."""

from itertools import permutations

import numpy as np

from ..core.poses import Array

EXACT = 6  # players up to which every assignment is compared


def assign(costs: Array) -> tuple[int, ...]:
    """Return the assignment of rows to columns with the least total cost.

    With more rows than columns, columns are used several times, but none
    more than once more often than another. Up to six rows all assignments
    are compared; beyond that a greedy one is improved by swapping pairs, so
    that no swap of two rows lowers its cost.

    Args:
        costs: Cost of each pair. Shape (rows, columns).

    Returns:
        Column of each row.
    """
    rows, columns = costs.shape
    uses = -(-rows // columns)  # of each column, at most
    slots = [column for column in range(columns) for _ in range(uses)]
    if rows <= EXACT and len(slots) <= EXACT + 1:
        return _best_of_all(costs, slots)
    return _improved(costs, slots)


def _best_of_all(costs: Array, slots: list[int]) -> tuple[int, ...]:
    rows = len(costs)
    options = dict.fromkeys(
        option for option in permutations(slots, rows) if _is_even(option)
    )
    totals = [costs[np.arange(rows), list(o)].sum() for o in options]
    return list(options)[int(np.argmin(totals))]


def _is_even(option: tuple[int, ...]) -> bool:
    """Return whether no column is left out while another is used twice."""
    counts = [option.count(column) for column in set(option)]
    return max(counts) - min(counts) <= 1


def _improved(costs: Array, slots: list[int]) -> tuple[int, ...]:
    rows, columns = costs.shape
    free, chosen = list(slots), [0] * rows
    order = np.argsort(costs.min(axis=1), kind="stable")
    used = dict.fromkeys(range(columns), 0)
    for row in order.tolist():
        least = min(used[column] for column in free)
        column = min(
            (c for c in set(free) if used[c] == least),
            key=lambda c: (costs[row, c], c),
        )
        chosen[row] = column
        used[column] += 1
        free.remove(column)
    swapped = True
    while swapped:
        swapped = False
        for i in range(rows):
            for j in range(i):
                a, b = chosen[i], chosen[j]
                now = costs[i, a] + costs[j, b]
                if costs[i, b] + costs[j, a] < now - 1e-12:
                    chosen[i], chosen[j] = b, a
                    swapped = True
    return tuple(chosen)
