"""Processor time of short calls."""

from collections.abc import Callable
from statistics import median
from time import process_time


def time_call(
    call: Callable[[], object], *, calls: int = 200, rounds: int = 15
) -> float:
    """Return the median over rounds of the mean time of a call, in [s]."""
    call()
    means = []
    for _ in range(rounds):
        start = process_time()
        for _ in range(calls):
            call()
        means.append((process_time() - start) / calls)
    return median(means)
