r"""Upwind scheme of one cell: slopes and the numerical Hamiltonian.

Every function takes numbers or arrays, so that compiled loops and NumPy
share the same formulas; the precision is that of the values.

With :math:`\Omega` the rate of the line of sight, the value obeys

.. math::
    V_\tau = \min_{u_p} \max_{u_e} \; \dot r V_r
        + (\Omega - u_p) V_a + (\Omega - u_e) V_\psi, \qquad V \le r

Each turning rate affects one coordinate only, so the Hamiltonian separates
into three one-dimensional ones, and Godunov's flux is exact for each.
"""

from typing import Any

import numpy as np

from ...core.compilation import inlined

HALF = np.float32(0.5)
ZERO = np.float32(0.0)
# Small integers are exact in single precision.
_TWO, _THREE, _FOUR = np.float32(2), np.float32(3), np.float32(4)
_FIVE, _SIX, _BEND = np.float32(5), np.float32(6), np.float32(13)


@inlined
def weno5(
    m3: Any, m2: Any, m1: Any, c: Any, p1: Any, p2: Any, p3: Any, eps: Any
) -> tuple[Any, Any]:
    """Compute one-sided differences to fifth order.

    Weighted essentially non-oscillatory scheme (Jiang and Peng, SIAM J. Sci.
    Comput. 21, 2000): three parabolas on each side, weighted by smoothness.

    Args:
        m3: Value three cells to the left.
        m2: Value two cells to the left.
        m1: Value one cell to the left.
        c: Value at the cell.
        p1: Value one cell to the right.
        p2: Value two cells to the right.
        p3: Value three cells to the right.
        eps: Twelve times the square of a difference that counts as smooth.

    Returns:
        Both one-sided slopes, times the spacing.
    """
    left, right = c - m1, p1 - c
    h0, h4 = (m1 - m2) - (m2 - m3), (p3 - p2) - (p2 - p1)
    h1, h2, h3 = left - (m1 - m2), right - left, (p2 - p1) - right
    e0, e1, e2, e3 = h1 - h0, h2 - h1, h3 - h2, h4 - h3
    e0, e1 = _BEND * e0 * e0 + eps, _BEND * e1 * e1 + eps
    e2, e3 = _BEND * e2 * e2 + eps, _BEND * e3 * e3 + eps
    # Smoothness of the outer, middle and inner parabola on either side.
    g = _THREE * h1 - h0
    s0 = e0 + _THREE * g * g
    g = h1 + h2
    s1 = e1 + _THREE * g * g
    g = h3 - _THREE * h2
    s2 = e2 + _THREE * g * g
    g = _THREE * h3 - h4
    t0 = e3 + _THREE * g * g
    g = h2 + h3
    t1 = e2 + _THREE * g * g
    g = h1 - _THREE * h2
    t2 = e1 + _THREE * g * g
    # Weights 1, 6, 3 over s**2, with a common denominator.
    x, y, z = s1 * s2, s0 * s2, s0 * s1
    x, y, z = x * x, _SIX * y * y, _THREE * z * z
    d = x * (_FIVE * h1 - _TWO * h0) + y * (h1 + _TWO * h2)
    left = left + (d + z * (_FOUR * h2 - h3)) / (_SIX * (x + y + z))
    x, y, z = t1 * t2, t0 * t2, t0 * t1
    x, y, z = x * x, _SIX * y * y, _THREE * z * z
    d = x * (_FIVE * h3 - _TWO * h4) + y * (h3 + _TWO * h2)
    right = right - (d + z * (_FOUR * h2 - h1)) / (_SIX * (x + y + z))
    return left, right


@inlined
def upwind_product(speed: Any, left: Any, right: Any) -> Any:
    """Return the speed times the slope on the side of the motion."""
    return HALF * (speed * (left + right) + abs(speed) * (right - left))


@inlined
def maximum(a: Any, b: Any) -> Any:
    """Return the elementwise maximum."""
    return HALF * (a + b + abs(a - b))


@inlined
def minimum(a: Any, b: Any) -> Any:
    """Return the elementwise minimum."""
    return HALF * (a + b - abs(a - b))


@inlined
def upwind(
    closing: Any,
    swing: Any,
    turn: Any,
    reach_p: Any,
    reach_e: Any,
    slopes: tuple[Any, Any, Any, Any, Any, Any],
) -> Any:
    """Return Godunov's Hamiltonian, the least dissipative monotone one.

    Args:
        closing: Rate of the distance, in [m/s].
        swing: Turning rate of the line of sight, in [rad/s].
        turn: Turning rate of the pursuer by its law, in [rad/s].
        reach_p: Largest deviation of the pursuer from its law, in [rad/s].
        reach_e: Largest turning rate of the evader, in [rad/s].
        slopes: Left and right slopes of the value along r, a and psi.

    Returns:
        Rate of the value, in [m/s].
    """
    rl, rr, al, ar, pl, pr = slopes
    drift = swing - turn
    low, high = drift - reach_p, drift + reach_p
    stall = minimum(maximum(low, ZERO), high)
    chase = minimum(upwind_product(low, al, ar), upwind_product(high, al, ar))
    chase = minimum(chase, upwind_product(stall, al, ar))
    low, high = swing - reach_e, swing + reach_e
    stall = minimum(maximum(low, ZERO), high)
    evade = maximum(upwind_product(low, pl, pr), upwind_product(high, pl, pr))
    evade = maximum(evade, upwind_product(stall, pl, pr))
    return upwind_product(closing, rl, rr) + chase + evade
