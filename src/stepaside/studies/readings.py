"""Readings: what one run says about the claims of a job, by name."""

from collections.abc import Sequence
from math import inf, isfinite, nan

Readings = dict[str, float]


def farthest(values: Sequence[float], expected: float) -> float:
    """Value that is farthest from an expected one; NaN if there is none."""
    if not len(values):
        return nan
    return float(max(values, key=lambda value: _off(value, expected)))


def _off(value: float, expected: float) -> float:
    """Distance from an expected value; a missing value is farthest off."""
    return abs(value - expected) if isfinite(value) else inf
