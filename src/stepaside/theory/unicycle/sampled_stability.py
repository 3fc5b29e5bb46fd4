r"""Stability of the circle under sampling and delay.

The held arc is the circle itself, so sampling and delay do not change the
circle; they only change the convergence to it.
"""

from collections.abc import Callable
from math import floor, inf, log, pi

import numpy as np

from ...core.errors import PlanError
from ...core.poses import Array
from .circles import (
    Circle,
    circle_of,
    relative_jacobian,
    sorted_eigenvalues,
)
from .unicycle_game import Unicycles

# Longest delay in sample times: each adds two rows to an eigenvalue problem.
MAX_DEPTH = 200
NODES = 24  # intervals of a collocation


def smooth_circle(game: Unicycles) -> Circle:
    """Return the main circle; raise unless the law is smooth about it.

    A saturated evader that slides on it chatters about zero error instead.
    """
    circle = circle_of(game)
    if not circle.exists:
        raise PlanError(
            "there is no circle for these speeds, gains and this angle"
        )
    if circle.sliding:
        raise PlanError(
            "the saturated evader slides on this circle; with sampling or "
            "delay it chatters about it, and no linearisation exists"
        )
    return circle


def _linearised(game: Unicycles) -> tuple[Array, Array, Array]:
    """Linearise the relative motion about the circle, and the laws.

    It returns derivatives of the rates of (r, a, psi) by the state (3, 3)
    and by the turning rates of both players (3, 2), and of the turning
    rates that the laws give by the state (2, 3).
    """
    own = smooth_circle(game)
    place = own.distance_m, own.pursuer_error_rad, own.bearing_rad
    gains = game.pursuer_gain, 0.0 if game.saturated else game.evader_gain
    laws = np.diag([0.0, *gains])[1:]
    return relative_jacobian(game, *place), -np.eye(3)[:, 1:], laws


def step_map(game: Unicycles, sample_time: float, delay: float = 0.0) -> Array:
    """Linearise one sampling period about the circle.

    Along the circle the relative state is constant, so the linearisation
    of the held motion has constant coefficients and its exponential is
    exact. With a delay, turning rates are queued, the newest first.

    Returns:
        Map of (r, a, psi, queued turning rates) over one period. Shape
        (n, n) with n = 3, or more with a delay.
    """
    from scipy.linalg import expm

    state, turning, feedback = _linearised(game)
    whole = floor(delay / sample_time + 1e-12)
    if whole > MAX_DEPTH:
        raise PlanError(
            f"delay must be at most {MAX_DEPTH} sample times, "
            f"{MAX_DEPTH * sample_time:g} [s], got {delay:g} [s]"
        )
    joint = np.zeros((5, 5))
    joint[:3] = np.hstack([state, turning])
    late = max(0.0, delay - whole * sample_time)
    early, rest = expm(joint * late), expm(joint * (sample_time - late))
    depth = whole + 1  # of the queue; the last acts at the begin of a period
    size = 3 + 2 * depth
    full = np.zeros((size, size))
    full[:3, :3] = rest[:3, :3] @ early[:3, :3]
    full[:3, -2:] = rest[:3, :3] @ early[:3, 3:]
    if whole == 0:
        full[:3, :3] += rest[:3, 3:] @ feedback
    else:
        full[:3, -4:-2] += rest[:3, 3:]
    full[3:5, :3] = feedback
    full[5:, 3:-2] = np.eye(size - 5)
    return full


def step_eigenvalues(
    game: Unicycles, sample_time: float, delay: float = 0.0
) -> tuple[complex, ...]:
    """Return the eigenvalues of the step map, the largest modulus first."""
    values = np.linalg.eigvals(step_map(game, sample_time, delay))
    found = map(complex, values)
    return tuple(sorted(found, key=lambda z: (-abs(z), -z.imag)))


def delayed_eigenvalues(game: Unicycles, delay: float) -> tuple[complex, ...]:
    """Return the slowest eigenvalues of the law with a delay, in [1/s].

    There is no sampling. The history over one delay is collocated at
    Chebyshev points.
    """
    state, turning, feedback = _linearised(game)
    n = NODES
    k = np.arange(n + 1)
    x = np.cos(pi * k / n)
    c = np.where((k == 0) | (k == n), 2.0, 1.0) * (-1.0) ** k
    gaps = x[:, None] - x[None, :] + np.eye(n + 1)
    d = np.outer(c, 1.0 / c) / gaps
    d -= np.diag(d.sum(axis=1))
    full = np.kron(d * (2.0 / delay), np.eye(3))
    full[:3] = 0.0
    full[:3, :3] = state
    full[:3, -3:] += turning @ feedback
    return sorted_eigenvalues(np.linalg.eigvals(full))[:3]


def growth_rate(game: Unicycles, sample_time: float, delay: float) -> float:
    """Return the rate at which the slowest deviation grows, in [1/s].

    It is negative where the circle is stable. A sample time of 0, in [s],
    stands for no sampling.
    """
    if sample_time > 0.0:
        size = abs(step_eigenvalues(game, sample_time, delay)[0])
        return log(size) / sample_time if size > 0.0 else -inf
    if delay > 0.0:
        return delayed_eigenvalues(game, delay)[0].real
    return smooth_circle(game).eigenvalues[0].real


def largest_stable_sample_time(game: Unicycles, delay: float = 0.0) -> float:
    """Return the sampling period, in [s], at which the circle loses stability.

    It is 0 if none is found to be stable with this delay, in [s], at a
    twentieth of which the search starts.
    """
    gain = max(game.pursuer_gain, game.evader_gain)
    if growth_rate(game, 0.0, delay) >= 0.0:
        return 0.0
    return _first_crossing(
        lambda time: growth_rate(game, time, delay),
        0.05 * delay or 1e-2 / gain,
        0.02 / gain,
    )


def largest_stable_delay(game: Unicycles, sample_time: float = 0.0) -> float:
    """Return the delay, in [s], at which the circle loses stability.

    It is 0 if the circle is unstable without delay.
    """
    gain = max(game.pursuer_gain, game.evader_gain)
    return _first_crossing(
        lambda delay: growth_rate(game, sample_time, delay), 0.0, 0.02 / gain
    )


def _first_crossing(
    excess: Callable[[float], float], low: float, step: float
) -> float:
    """Return the least argument with a positive excess; inf if none."""
    from scipy.optimize import brentq

    if excess(low) >= 0.0:
        return 0.0
    for _ in range(4000):
        if excess(low + step) >= 0.0:
            return float(brentq(excess, low, low + step))
        low += step
        step *= 1.02
    return inf
