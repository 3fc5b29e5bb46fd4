r"""Limit circles of the two players: equilibria of the relative motion.

In relative coordinates a circle is an equilibrium:
:math:`v_e \cos\psi = v_p \cos a`, and both players turn with the line of
sight, :math:`\omega = k_p a = \Omega = \omega_e`, with :math:`\omega_e = k_e
b` (4), or :math:`\omega_e = \pm k_e` or :math:`b = 0` (6). All errors are
wrapped to (-pi, pi]; all quantities are those of side +1, and side -1 is the
mirror image.

Discontinuities that repel the motion on both sides (the errors at
:math:`\pm\pi`, the change of side) are not equilibria.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import acos, cos, inf, log, nan, pi, sin
from typing import Any

import numpy as np

from ...core.poses import Array, wrap_angle
from .unicycle_game import Unicycles

_PIECES = 96  # intervals of the turning rate that are searched for roots
_HALVINGS = 64  # of a bracket, down to rounding
_ROUNDING = 1e-12  # speed ratio, rate ratio or error that counts as zero
PRECISION = 1e-6  # to which a deviation from a circle decays until settled


@dataclass(frozen=True, slots=True)
class Circle:
    """Limit set of the game: concentric circles of the two players.

    Given for side +1; side -1 has the mirror image. Quantities are NaN and
    ``eigenvalues`` is empty if no circle exists.
    """

    exists: bool  # whether the circle exists
    radius_pursuer_m: float = nan  # radius of the pursuer's circle, in [m]
    radius_evader_m: float = nan  # radius of the evader's circle, in [m]
    distance_m: float = nan  # distance between the two, in [m]
    turning_rate_rad_s: float = nan  # common turning rate, in [rad/s]
    headings_apart_rad: float = nan  # angle between the headings, in [rad]
    # Angle between the directions of motion, in [rad].
    motions_apart_rad: float = nan
    # Eigenvalues of the linearisation, slowest first, in [1/s]; of the
    # sliding motion if the evader slides.
    eigenvalues: tuple[complex, ...] = ()
    stable: bool = False  # whether all of them have negative real part
    # Time constant of the slowest mode, in [s]; inf if unstable.
    time_constant_s: float = nan
    # Error of the pursuer on the circle, in [rad].
    pursuer_error_rad: float = nan
    # Error of the evader on the circle, in [rad].
    evader_error_rad: float = nan
    # Bearing of the pursuer in the evader's frame, not wrapped: the evader's
    # error minus the angle, in [rad].
    bearing_rad: float = nan
    sliding: bool = False  # whether the saturated evader slides on zero error

    @property
    def direction(self) -> int:
        """Sign of the turning rate: +1 for the main sense, 0 for none."""
        return (self.turning_rate_rad_s > 0) - (self.turning_rate_rad_s < 0)

    @property
    def behind(self) -> bool:
        """Whether side +1 is the one behind the evader on the circle.

        If not, only an evader that keeps its side can stay on the circle.
        """
        return -pi < self.bearing_rad < 0.0


def circles_of(game: Unicycles) -> tuple[Circle, ...]:
    r"""Find all equilibria of the relative motion allowed by the side rule.

    Circles are given for side +1, with errors in :math:`(-\pi, \pi]`; side
    -1 has their mirror images. Under ``BEHIND`` side +1 must be the side
    behind the evader, up to the hysteresis. An evader that keeps its side
    has those circles and possibly others, which ``Circle.behind``
    distinguishes. At angles 0 and pi both sides coincide, and a circle and
    its mirror image both appear.

    Returns:
        Those that turn in the main sense first, then the reversed ones;
        slowest first in each group.
    """
    vp, ve, kp, ke, alpha = game.numbers
    found, rests = [], _saturated if game.saturated else _proportional
    for rate, b, sliding in rests(game):
        a, psi = rate / kp, b - alpha
        across = vp * sin(a) - ve * sin(psi)
        apart = abs(across) > _ROUNDING * max(vp, ve) and across * rate > 0.0
        reach = inf if game.keeps_side else 0.5 * pi + game.hysteresis
        if not (apart and -pi < a <= pi and -pi < b <= pi):
            continue
        if not abs(psi + 0.5 * pi) < reach:
            continue
        loops = relative_jacobian(game, across / rate, a, psi)
        loops[1, 1] -= kp
        loops[2, 2] -= 0.0 if game.saturated else ke
        size = 2 if sliding else 3
        values = sorted_eigenvalues(np.linalg.eigvals(loops[:size, :size]))
        slowest = values[0].real
        circle = Circle(
            exists=True,
            radius_pursuer_m=vp / abs(rate),
            radius_evader_m=ve / abs(rate),
            distance_m=across / rate,
            turning_rate_rad_s=rate,
            headings_apart_rad=abs(wrap_angle(a - psi - pi)),
            motions_apart_rad=abs(wrap_angle(a - psi)),
            eigenvalues=values,
            stable=slowest < 0.0,
            time_constant_s=-1.0 / slowest if slowest < 0.0 else inf,
            pursuer_error_rad=a,
            evader_error_rad=b,
            bearing_rad=psi,
            sliding=sliding,
        )
        found.append(circle)
    found.sort(key=lambda c: (-c.direction, abs(c.turning_rate_rad_s)))
    return tuple(found)


def circle_of(game: Unicycles) -> Circle:
    """Find the main circle: the slowest with a positive rate at side +1.

    Under the side rule ``BEHIND`` its bearing is negative, without
    hysteresis; under (6) the evader does not look past its pursuer.
    """
    for circle in circles_of(game):
        anywhere = game.keeps_side and not game.saturated
        behind = circle.bearing_rad < (_ROUNDING if game.keeps_side else 0.0)
        if circle.direction > 0 and (anywhere or behind):
            return circle
    return Circle(exists=False)


def find_circle(*values: Any, **named: Any) -> Circle:
    """Find the main circle of the game of :func:`.Unicycles`."""
    return circle_of(Unicycles(*values, **named))


def settling_time(game: Unicycles) -> float:
    """Return the duration after which the last turn is a circle, in [s]."""
    gain = min(game.pursuer_gain, game.evader_gain)
    ends = [
        -log(PRECISION) * circle.time_constant_s
        + 2.0 * pi / abs(circle.turning_rate_rad_s)
        for circle in circles_of(game)
        if circle.stable
    ]
    return 30.0 / gain + max(ends, default=30.0 / gain)


def fit_circle(points: Array) -> tuple[Array, float]:
    """Fit centre (2,) and radius of a circle to points (n, 2), in [m].

    Linear least squares.
    """
    origin = points.mean(axis=0)
    local = points - origin
    matrix = np.column_stack([2.0 * local, np.ones(len(local))])
    squares = (local**2).sum(axis=1)
    (x, y, rest), *_ = np.linalg.lstsq(matrix, squares, rcond=None)
    return origin + (x, y), float(np.sqrt(rest + x * x + y * y))


def relative_jacobian(
    game: Unicycles, r: float, a: float, psi: float
) -> Array:
    """Linearise the relative motion with the turning rates held.

    It is the derivative of the rates of (r, a, psi). Shape (3, 3).
    """
    vp, ve, *_ = game.numbers
    rate = (vp * sin(a) - ve * sin(psi)) / r  # of the line of sight
    sight = [-rate / r, vp * cos(a) / r, -ve * cos(psi) / r]
    return np.array([[0.0, vp * sin(a), -ve * sin(psi)], sight, sight])


def sorted_eigenvalues(values: Any) -> tuple[complex, ...]:
    """Return eigenvalues, the slowest (largest real part) first."""
    found = map(complex, values)
    return tuple(sorted(found, key=lambda s: (-s.real, -s.imag)))


def _proportional(game: Unicycles) -> Iterator[tuple[float, float, bool]]:
    """Find turning rates and errors of the evader at rest under (4).

    The rate of the distance is a sum of two sinusoids of the turning rate,
    and the range that errors allow holds one period of the faster one. So
    the intervals are short: between two knots it has one extremum at most.
    """
    vp, ve, kp, ke, alpha = game.numbers

    def opening(rate: float) -> float:  # without cancellation for vp = ve
        a, u = rate / kp, alpha - rate / ke
        both = sin(0.5 * (u + a)) * sin(0.5 * (u - a))
        return (ve - vp) * cos(a) - 2.0 * ve * both

    def slope(rate: float) -> float:
        return ve / ke * sin(alpha - rate / ke) + vp / kp * sin(rate / kp)

    top = pi * min(kp, ke)
    knots: list[float] = np.linspace(-top, top, _PIECES + 1).tolist()
    for rate in _roots(opening, sorted([*knots, *_roots(slope, knots)])):
        yield rate, rate / ke, False


def _roots(
    function: Callable[[float], float], knots: list[float]
) -> Iterator[float]:
    """Bisect intervals whose ends differ in sign, down to rounding."""
    for low, high in pairwise(knots):
        rising = function(high) > 0.0
        if rising == (function(low) > 0.0):
            continue
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if (function(middle) > 0.0) == rising:
                high = middle
            else:
                low = middle
        yield 0.5 * (low + high)


def _saturated(game: Unicycles) -> Iterator[tuple[float, float, bool]]:
    """Find rests under (6): at full rate in either sense, or sliding.

    Where both coincide, it counts as one at full rate.
    """
    vp, ve, kp, ke, alpha = game.numbers
    full, slid = vp / ve * cos(ke / kp), ve / vp * cos(alpha)
    for way in (1.0, -1.0):
        if abs(full) <= 1.0:
            for bearing in sorted({acos(full), -acos(full) % (2.0 * pi)}):
                b = wrap_angle(alpha - bearing)
                b = 0.0 if abs(b) < _ROUNDING else b
                if way * b >= 0.0:
                    yield way * ke, b, False
        if abs(slid) < 1.0 and kp * acos(slid) < ke * (1.0 - _ROUNDING):
            yield way * kp * acos(slid), 0.0, True
