r"""Equilibria of the relative motion, for many games at once.

In relative coordinates a circle is an equilibrium:
:math:`v_e \cos\psi = v_p \cos a`, and both players turn with the line of
sight, :math:`\omega = k_p a = \Omega = \omega_e`. All errors are wrapped to
(-pi, pi]; all quantities are those of side +1, and side -1 is the mirror
image. The evader keeps its side here; the side rule is applied elsewhere
(:mod:`.all_circles`).

Discontinuities that repel the motion on both sides (the errors at
:math:`\pm\pi`, the change of side) are not equilibria.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .stability import loop_matrices

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]
Function = Callable[["GameParameters", Array], Array]
Found = tuple[Indices, Array, Array, Flags]  # game, rate, b, sliding
_PIECES = 96  # intervals of the turning rate that are searched for roots
_HALVINGS = 64  # of a bracket, down to rounding
_COINCIDENT = 1e-12  # speed ratio below which the distance is zero


class GameParameters(NamedTuple):
    """Parameters of many games, as arrays of one shape.

    Attributes:
        pursuer_speed: Speed of the pursuer, in [m/s].
        evader_speed: Speed of the evader, in [m/s].
        pursuer_gain: Gain of the pursuer, in [1/s].
        evader_gain: Gain of the evader, in [1/s]; saturated, its turning
            rate, in [rad/s].
        angle: Evasion angle in [0, pi], in [rad].
    """

    pursuer_speed: Array
    evader_speed: Array
    pursuer_gain: Array
    evader_gain: Array
    angle: Array

    @classmethod
    def of(cls, *values: ArrayLike) -> "GameParameters":
        """Broadcast values to games of shape (n,)."""
        arrays = [np.atleast_1d(np.asarray(v, np.float64)) for v in values]
        return cls(*np.broadcast_arrays(*arrays))

    def pick(self, index: Any) -> "GameParameters":
        """Return indexed games, or a view with another shape."""
        return GameParameters(*(values[index] for values in self))


@dataclass(frozen=True, slots=True)
class Equilibria:
    """Equilibria of many games, unordered; every array has shape (n,).

    Attributes:
        game: Index of the game.
        turning_rate: Common turning rate, signed, in [rad/s].
        pursuer_error: Error of the pursuer, in (-pi, pi], in [rad].
        evader_error: Error of the evader, in (-pi, pi], in [rad].
        distance: Distance, in [m].
        sliding: Whether the saturated evader slides on zero error.
    """

    game: Indices
    turning_rate: Array
    pursuer_error: Array
    evader_error: Array
    distance: Array
    sliding: Flags


def find_equilibria(games: GameParameters, *, saturated: bool) -> Equilibria:
    """Find all equilibria of games whose evader keeps its side.

    Args:
        games: Parameters of the games, of shape (n,).
        saturated: Whether the evader turns by (6) rather than by (4).

    Returns:
        Equilibria with a positive distance.
    """
    found = _saturated(games) if saturated else _proportional(games)
    index, rate, b, sliding = found
    vp, ve, kp, _, alpha = games.pick(index)
    a = rate / kp
    across = vp * np.sin(a) - ve * np.sin(b - alpha)
    distant = np.abs(across) > _COINCIDENT * np.maximum(vp, ve)
    keep = distant & (across * rate > 0.0) & (a > -pi) & (a <= pi)
    keep &= (b > -pi) & (b <= pi)
    distance = across[keep] / rate[keep]
    return Equilibria(
        index[keep], rate[keep], a[keep], b[keep], distance, sliding[keep]
    )


def imbalance(games: GameParameters, rate: Array) -> Array:
    """Return the rate of the distance at turning rates under (4), in [m/s].

    The form avoids cancellation for equal speeds.
    """
    vp, ve, kp, ke, alpha = games
    a, u = rate / kp, alpha - rate / ke
    difference = -2.0 * np.sin(0.5 * (u + a)) * np.sin(0.5 * (u - a))
    found: Array = (ve - vp) * np.cos(a) + ve * difference
    return found


def _slope(games: GameParameters, rate: Array) -> Array:
    """Return the derivative of the imbalance by the turning rate, in [m]."""
    vp, ve, kp, ke, alpha = games
    evader = ve / ke * np.sin(alpha - rate / ke)
    found: Array = evader + vp / kp * np.sin(rate / kp)
    return found


def _proportional(games: GameParameters) -> Found:
    """Find the roots of the imbalance over all rates that errors allow.

    The imbalance is a sum of two sinusoids, and the range holds one period
    of the faster one. So the intervals are short: between two knots it
    crosses zero at most once, or has one extremum with two or no roots.
    """
    top = pi * np.minimum(games.pursuer_gain, games.evader_gain)
    knots = np.linspace(-1.0, 1.0, _PIECES + 1)[:, None] * top
    value = imbalance(games.pick(None), knots)
    slope = _slope(games.pick(None), knots)
    above = value > 0.0
    crosses = above[1:] != above[:-1]
    towards = (slope[:-1] < 0.0) == above[:-1]
    returns = ~crosses & towards & ((slope[1:] > 0.0) == above[1:])
    piece, index = np.nonzero(returns)
    low, high = knots[piece, index], knots[piece + 1, index]
    turn = _bisect(_slope, games.pick(index), low, high)
    beyond = (imbalance(games.pick(index), turn) > 0.0) != above[piece, index]
    piece, index, turn = piece[beyond], index[beyond], turn[beyond]
    lows = [knots[piece, index], turn]
    highs = [turn, knots[piece + 1, index]]
    where = [index, index]
    piece, index = np.nonzero(crosses)
    low = np.concatenate([*lows, knots[piece, index]])
    high = np.concatenate([*highs, knots[piece + 1, index]])
    index = np.concatenate([*where, index])
    rate = _bisect(imbalance, games.pick(index), low, high)
    sliding = np.zeros(len(index), dtype=np.bool_)
    return index, rate, rate / games.evader_gain[index], sliding


def _bisect(
    function: Function,
    games: GameParameters,
    low: Array,
    high: Array,
) -> Array:
    """Bisect brackets with a sign change down to rounding."""
    rising = function(games, high) > 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        right = (function(games, middle) > 0.0) == rising
        low, high = np.where(right, low, middle), np.where(right, middle, high)
    found: Array = 0.5 * (low + high)
    return found


def _saturated(games: GameParameters) -> Found:
    """Find equilibria under (6): at full rate in either sense, or sliding.

    Where both coincide, the equilibrium counts as one at full rate.
    """
    vp, ve, kp, ke, alpha = games
    count = len(vp)
    rates, errors, slides = [], [], []
    with np.errstate(invalid="ignore"):
        bearing = np.arccos(vp / ve * np.cos(ke / kp))  # NaN if none
        slid = np.arccos(ve / vp * np.cos(alpha))
    for way in (1.0, -1.0):
        for sign in (-1.0, 1.0):
            b = alpha + sign * bearing
            b = np.where(b > pi, b - 2.0 * pi, b)
            twice = (sign > 0.0) & np.isin(bearing, (0.0, pi))
            rates.append(way * ke)
            errors.append(np.where((way * b >= 0.0) & ~twice, b, np.nan))
            slides.append(np.zeros(count, dtype=np.bool_))
        rate = np.where((slid > 0.0) & (kp * slid < ke), way * kp * slid, 1.0)
        rates.append(rate)
        errors.append(np.where(rate == way * kp * slid, 0.0, np.nan))
        slides.append(np.ones(count, dtype=np.bool_))
    index = np.tile(np.arange(count), len(rates))
    b = np.concatenate(errors)
    real = np.isfinite(b)
    rate, sliding = np.concatenate(rates), np.concatenate(slides)
    return index[real], rate[real], b[real], sliding[real]


def growth_rates(
    equilibria: Equilibria, games: GameParameters, *, saturated: bool
) -> Array:
    """Return the largest real part of the eigenvalues of each equilibrium.

    Args:
        equilibria: Equilibria of the games.
        games: Parameters of the games.
        saturated: Whether the evader turns by (6) rather than by (4).

    Returns:
        Rates, in [1/s], of the sliding motion where the evader slides;
        negative where the circle is stable. Shape (m,) for m equilibria.
    """
    vp, ve, kp, ke, alpha = games.pick(equilibria.game)
    a, psi = equilibria.pursuer_error, equilibria.evader_error - alpha
    loops = loop_matrices(
        (vp, ve),
        (kp, 0.0 * ke if saturated else ke),
        equilibria.distance,
        a,
        psi,
    )
    found = np.empty(len(a))
    for slides, size in ((False, 3), (True, 2)):
        some = equilibria.sliding == slides
        values = np.linalg.eigvals(loops[some, :size, :size])
        found[some] = values.real.max(axis=-1)
    return found
