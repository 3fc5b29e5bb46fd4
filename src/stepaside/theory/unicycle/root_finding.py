"""Roots of a smooth function on an interval."""

from collections.abc import Callable

Function = Callable[[float], float]


def bisect(function: Function, low: float, high: float) -> float:
    """Bisect a bracket with a sign change down to adjacent doubles."""
    rising = function(high) > 0.0
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return middle
        if (function(middle) > 0.0) == rising:
            high = middle
        else:
            low = middle


def sign_changes(
    function: Function, low: float, high: float, *, pieces: int = 720
) -> list[float]:
    """Find the sign changes of a function, in increasing order.

    The interval is divided into pieces. Where the function approaches zero
    without crossing it, a close pair of roots is searched at the extremum.

    Args:
        function: Smooth function of one variable.
        low: Open lower end of the interval.
        high: Upper end of the interval.
        pieces: Number of pieces.

    Returns:
        Arguments at which the sign changes, to rounding.
    """
    if not high > low:
        return []
    knots = [low + (high - low) * i / pieces for i in range(pieces + 1)]
    values = [function(knot) for knot in knots]
    roots: list[float] = []
    for i in range(pieces):
        left, right = values[i], values[i + 1]
        if left != 0.0 and (left > 0.0) != (right > 0.0):
            roots.append(bisect(function, knots[i], knots[i + 1]))
        elif 0 < i and abs(left) < min(abs(values[i - 1]), abs(right)):
            if (values[i - 1] > 0.0) == (left > 0.0):
                roots += _close_pair(function, knots[i - 1], knots[i + 1])
    return sorted(roots)


def _close_pair(function: Function, low: float, high: float) -> list[float]:
    """Find two sign changes on either side of an extremum near zero."""
    sign = 1.0 if function(low) > 0.0 else -1.0
    left, right = low, high
    for _ in range(80):  # ternary search of the extremum
        third = (right - left) / 3.0
        if sign * function(left + third) < sign * function(right - third):
            right -= third
        else:
            left += third
    lowest = 0.5 * (left + right)
    if sign * function(lowest) >= 0.0:
        return []
    return [bisect(function, low, lowest), bisect(function, lowest, high)]
