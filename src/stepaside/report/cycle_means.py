"""Means over whole gait cycles, as figures and pages show them."""

import numpy as np

from ..core.poses import Array
from ..games.duel_circle import cycle_mean


def whole_cycles(values: Array, times: Array, period: float) -> Array:
    """Return the mean over the gait cycle around each sample.

    Near both ends the window of
    :func:`~stepaside.games.duel_circle.cycle_mean` is truncated and its mean
    biased by the sway, so these samples are NaN.

    Args:
        values: Samples. Shape (n,).
        times: Their times, evenly spaced, in [s]. Shape (n,).
        period: Duration of a gait cycle (two steps), in [s].

    Returns:
        Means; NaN within half a cycle of both ends. Shape (n,).
    """
    mean = cycle_mean(values, times, period).astype(float)
    if len(times) < 3:
        return np.full(len(times), np.nan)
    half = round(period / float(times[1] - times[0])) // 2
    mean[:half] = mean[max(len(mean) - half, 0) :] = np.nan
    return mean
