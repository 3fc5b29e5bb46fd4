"""ZMP reference as a piecewise polynomial (paper, Sec. III-D)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..core.poses import Array


@dataclass(frozen=True, slots=True)
class PiecewisePolynomial:
    r"""Piecewise polynomial in local time, then a constant."""

    durations: Array  # duration of each piece [s]. Shape (n,)
    coefficients: Array  # [m/s^j] (degree + 1, n, ...)

    @property
    def end(self) -> Array:
        """Value at the end of the last piece. Shape (...)."""
        value: Array = evaluate(self.coefficients, self.durations)[-1]
        return value

    def locate(self, times: ArrayLike) -> tuple[np.ndarray, Array]:
        """Return the piece of each time, and the local time in it, in [s].

        Local times exceed the duration only after the end.
        """
        t = np.asarray(times, dtype=np.float64)
        starts = np.concatenate([[0.0], np.cumsum(self.durations)[:-1]])
        index = np.searchsorted(starts, t, side="right") - 1
        index = np.clip(index, 0, self.durations.size - 1)
        return index, t - starts[index]


def evaluate(coefficients: Array, local_times: Array) -> Array:
    """Evaluate polynomials (degree + 1, m, ...) at local times (m,) in [s]."""
    s = local_times.reshape(-1, *[1] * (coefficients.ndim - 2))
    value = np.zeros(coefficients.shape[1:])
    for coefficient in coefficients[::-1]:
        value = value * s + coefficient
    return value


def least_values(coefficients: Array, duration: float) -> Array:
    """Return the least values of cubic polynomials over [0, duration].

    They are at an end or where the derivative vanishes.

    ``coefficients``: Of the powers 0 to 3. Shape (4, n).
    """
    c0, c1, c2, c3 = coefficients
    # Roots of c1 + 2 c2 s + 3 c3 s^2 without cancellation, also if any is 0.
    root = np.sqrt(np.maximum(c2 * c2 - 3.0 * c3 * c1, 0.0))
    half = -(c2 + np.copysign(root, c2))
    with np.errstate(divide="ignore", invalid="ignore"):
        turns = np.array([half / (3.0 * c3), c1 / half])
    # Without a root the candidate is clipped to an end, which is harmless.
    turns = np.clip(np.nan_to_num(turns), 0.0, duration)
    times = np.vstack([np.zeros_like(c1), np.full_like(c1, duration), turns])
    values = c0 + (c1 + (c2 + c3 * times) * times) * times
    least: Array = values.min(axis=0)
    return least
