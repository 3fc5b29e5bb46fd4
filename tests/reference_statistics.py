"""Independent statistics, and records with different outcomes."""

from collections.abc import Sequence
from math import comb, sqrt
from statistics import NormalDist

NORMAL = NormalDist().inv_cdf(0.975)  # of a two-sided 95 % interval


def is_wilson(low: float, high: float, hits: int, number: int) -> bool:
    """Whether bounds solve Wilson's equation: both ends are 1.96 off.

    Args:
        low: Lower bound of the share.
        high: Upper bound.
        hits: How many there were.
        number: Of how many.
    """
    least, most = hits / number - 1e-12, hits / number + 1e-12
    if not (0.0 <= low <= most and least <= high <= 1.0):
        return False
    return all(
        abs(abs(hits / number - end) - NORMAL * sqrt(end * (1 - end) / number))
        < 1e-4
        for end, open_ended in ((low, hits > 0), (high, hits < number))
        if open_ended
    )


def coverage(bounds: Sequence[tuple[float, float]], share: float) -> float:
    """How often intervals hold the true share, if each hit has that chance.

    Args:
        bounds: Interval of each number of hits, from none to all.
        share: The true one.
    """
    number = len(bounds) - 1
    return sum(
        comb(number, hits) * share**hits * (1.0 - share) ** (number - hits)
        for hits, (low, high) in enumerate(bounds)
        if low <= share <= high
    )
