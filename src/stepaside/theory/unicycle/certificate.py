r"""Certified lower bound of the distance over a whole game.

Equal speeds :math:`v` and gains :math:`k`, proportional laws, side +1 (side
-1 is the mirror image). With :math:`d = a - b`,
:math:`x = (a + b - \alpha) / 2`, :math:`z = r e^{ix}`,
:math:`c(d) = 2 v \sin((\alpha + d) / 2)`, :math:`r^* = 2 c(0) / (k \alpha)`
and :math:`\rho = |z - r^*|`, while no error wraps and no side changes,

.. math::
    \dot d = -k d, \qquad
    \tfrac12 \tfrac{d}{dt} \rho^2
    = r \sin x \, [c(d) - c(0) - k r^* x],

so that, :math:`\Delta = |c(d) - c(0)|`,

.. math::
    \dot\rho \le \min\Bigl(\Delta,\;
    \frac{(r^* + \rho) \Delta^2}{4 k r^* \rho}\Bigr).

Integrated over the known decay of :math:`d` this bounds :math:`\rho`, and
:math:`r \ge r^* - \rho`. No error wraps in a game that starts in the diamond
:math:`|a| + |\psi| < \pi`, which no game leaves, for any sequence of sides,
as long as the evader's error does not wrap: with :math:`x = (a + \psi) / 2`,
:math:`e = a - \psi` and :math:`p = r \cos x`,

.. math::
    \dot e = -k (e - \sigma\alpha), \qquad
    \dot p = k (x + \sigma\alpha / 2) \, p \tan x \ge -k p.

Proofs in ``docs/unicycles.md``.
"""

from cmath import exp
from math import asin, log, pi, sin

import numpy as np

from ...core.errors import PlanError
from ..laws import evasion_heading, side_behind
from .circles import circle_of
from .simulation import RelativeStart
from .unicycle_game import Unicycles, check_side

_FACTOR = 0.98  # ratio of |d| at successive knots of the integration
_STOPS = 2000  # points on the boundary of the disc that contains the game
_TAIL = 1e-6  # |d| below which the remainder is at most v |d| / k, in [rad]


def certify(
    game: Unicycles, start: RelativeStart, *, side: int = 0
) -> float | None:
    """Bound the distance at all times of a game from below, in [m].

    A game with a bound converges to the circle. None if none is proved: a
    bound is positive, no error wraps and no side changes.

    Args:
        game: Parameters, with equal speeds and gains, the proportional law,
            and an angle above zero.
        start: Initial relative coordinates.
        side: Initial side, +1 or -1; 0 for the one behind the evader.
    """
    vp, ve, kp, ke, alpha = game.numbers
    if vp != ve or kp != ke or game.saturated or alpha == 0.0:
        raise PlanError(
            "the certificate needs equal speeds and gains, the proportional "
            f"law and an angle > 0 [rad], got {game}"
        )
    check_side(side)
    radius = circle_of(game).distance_m
    r, a, psi = start.wrapped()
    if side == 0:
        side = side_behind(psi)
    a, psi = side * a, side * psi
    if psi > 0.0 and not game.keeps_side:
        return None  # the side changes immediately
    b = evasion_heading(psi, 1, alpha)
    d, x = a - b, 0.5 * (a + b - alpha)
    spread = abs(r * exp(1j * x) - radius)
    spread = _largest_spread(spread, d, game, radius)
    bound = radius - spread
    unwrapped = stays_unwrapped(game, a, psi) or _unwrapped(
        game, bound, radius, d
    )
    if bound > 0.0 and unwrapped and _keeps_side(game, bound, radius):
        return bound
    return None


def stays_unwrapped(
    game: Unicycles, pursuer_error: float, bearing: float
) -> bool:
    """Return whether no error of a game between equal players ever wraps.

    It is proved inside the diamond, for an evader with the side rule
    "behind" (its error never exceeds the angle), or for one that keeps its
    side at an angle of at most pi / 2 and whose initial error is below pi.
    Both angles are mirrored to side +1, in [-pi, pi].
    """
    if not abs(pursuer_error) + abs(bearing) < pi:
        return False
    if not game.keeps_side:
        return True
    return game.angle <= 0.5 * pi and bearing < pi - game.angle


def _largest_spread(
    spread: float, d: float, game: Unicycles, radius: float
) -> float:
    """Return an upper sum of the comparison equation over the decay of d."""
    speed, gain = game.pursuer_speed, game.pursuer_gain
    size, sign = abs(d), 1.0 if d > 0.0 else -1.0
    while size > _TAIL:
        smaller = _FACTOR * size
        ends = sorted((sign * size, sign * smaller))
        largest = 2.0 * speed * largest_change(game.angle, *ends)
        if spread > 0.0:
            slow = (radius + spread) * largest**2
            largest = min(largest, slow / (4.0 * gain * radius * spread))
        spread += largest * log(1.0 / _FACTOR) / gain
        size = smaller
    return spread + speed * size / gain


def largest_change(alpha: float, low: float, high: float) -> float:
    """Return the maximum of |sin((alpha + d) / 2) - sin(alpha / 2)|.

    The interval of d lies within (-2 pi, 2 pi).
    """
    # The sine has its maximum at pi - alpha and its minimum at -pi - alpha.
    extrema = [d for d in (pi - alpha, -pi - alpha) if low < d < high]
    centre = sin(0.5 * alpha)
    return max(
        abs(sin(0.5 * (alpha + d)) - centre) for d in (low, high, *extrema)
    )


def _unwrapped(game: Unicycles, bound: float, radius: float, d: float) -> bool:
    """Return whether a bound rules out that an error wraps.

    An error reaches pi only where the line of sight turns at a rate of k pi
    or more, or where the state is far enough from the circle.
    """
    tilt = asin(min(1.0, (radius - bound) / radius))
    if tilt + 0.5 * (game.angle + abs(d)) < pi:
        return True
    return bound * game.evader_gain * pi > 2.0 * game.evader_speed


def _keeps_side(game: Unicycles, bound: float, radius: float) -> bool:
    """Return whether a bound rules out that the side changes.

    The side changes only where the line of sight, which then turns at
    v |sin 2 x| / r, turns faster than the evader. On every ray the nearest
    point of the disc around r* is on its boundary, which is sampled with a
    Lipschitz bound between samples.
    """
    if game.keeps_side:
        return True
    speed, gain = game.evader_speed, game.evader_gain
    slowest = gain * min(game.angle, pi - game.angle)
    if game.hysteresis > 0.0 or slowest == 0.0:
        return False
    if bound * slowest > speed:
        return True
    spread, far = radius - bound, 2.0 * radius - bound
    slope = spread * (3.0 * slowest * far**2 + 4.0 * speed * far)
    slack = slope * pi / _STOPS
    around = pi * np.arange(_STOPS + 1) / _STOPS
    z = radius - spread * np.exp(-1j * around)
    lead = slowest * np.abs(z) ** 3 - 2.0 * speed * z.real * z.imag
    return bool(lead.min() > slack)
