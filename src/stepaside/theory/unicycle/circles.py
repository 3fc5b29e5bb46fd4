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

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, nan, pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.poses import wrap_angle
from .unicycle_game import Game, make_game

Array = NDArray[np.float64]
Function = Callable[["GameParameters", Array], Array]
Found = tuple[NDArray[np.int64], Array, Array, NDArray[np.bool_]]
_PIECES = 96  # intervals of the turning rate that are searched for roots
_HALVINGS = 64  # of a bracket, down to rounding
_ROUNDING = 1e-12  # speed ratio, rate ratio or error that counts as zero


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


class GameParameters(NamedTuple):
    """Parameters of many games, as arrays of one shape; see :class:`.Game`.

    Speeds in [m/s], gains in [1/s], the evasion angle in [0, pi] in [rad].
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

    They have the index of their game, common turning rate [rad/s], errors
    in (-pi, pi] [rad], distance [m], and whether the saturated evader
    slides on zero error.
    """

    game: NDArray[np.int64]
    turning_rate: Array
    pursuer_error: Array
    evader_error: Array
    distance: Array
    sliding: NDArray[np.bool_]

    def eigenvalues(
        self, games: GameParameters, *, saturated: bool
    ) -> NDArray[np.complex128]:
        """Return the eigenvalues of the linearisation, in [1/s]. Shape (n, 3).

        Where the evader slides, they are two of the sliding motion, on which
        the bearing is constant, and minus infinity: that is reached in finite
        time.
        """
        vp, ve, kp, ke, alpha = games.pick(self.game)
        psi = self.evader_error - alpha
        loops = relative_jacobian(
            vp, ve, self.distance, self.pursuer_error, psi
        )
        loops[:, 1, 1] -= kp
        loops[:, 2, 2] -= 0.0 * ke if saturated else ke
        found = np.full((len(vp), 3), -inf, dtype=np.complex128)
        for slides, size in ((False, 3), (True, 2)):
            some = self.sliding == slides
            found[some, :size] = np.linalg.eigvals(loops[some, :size, :size])
        return found


def relative_jacobian(vp: Any, ve: Any, r: Any, a: Any, psi: Any) -> Array:
    """Linearise the relative motion with the turning rates held.

    It is the derivative of the rates of (r, a, psi), for speeds vp and ve,
    for numbers or arrays of one shape. Shape (..., 3, 3).
    """
    rate = (vp * np.sin(a) - ve * np.sin(psi)) / r  # of the line of sight
    opening = np.array([0.0 * rate, vp * np.sin(a), -ve * np.sin(psi)])
    sight = np.array([-rate, vp * np.cos(a), -ve * np.cos(psi)]) / r
    rows = np.stack([opening, sight, sight])
    found: Array = np.moveaxis(rows, (0, 1), (-2, -1))
    return found


def find_equilibria(games: GameParameters, *, saturated: bool) -> Equilibria:
    """Find all equilibria of games whose evader keeps its side."""
    found = _saturated(games) if saturated else _proportional(games)
    index, rate, b, sliding = found
    vp, ve, kp, _, alpha = games.pick(index)
    a = rate / kp
    across = vp * np.sin(a) - ve * np.sin(b - alpha)
    distant = np.abs(across) > _ROUNDING * np.maximum(vp, ve)
    keep = distant & (across * rate > 0.0) & (a > -pi) & (a <= pi)
    keep &= (b > -pi) & (b <= pi)
    distance = across[keep] / rate[keep]
    return Equilibria(
        index[keep], rate[keep], a[keep], b[keep], distance, sliding[keep]
    )


def circles_of(game: Game) -> tuple[Circle, ...]:
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
    vp, ve = game.pursuer.speed, game.evader.speed
    games = GameParameters.of(
        vp, ve, game.pursuer.gain, game.evader.gain, game.angle
    )
    found = find_equilibria(games, saturated=game.saturated)
    modes = found.eigenvalues(games, saturated=game.saturated)
    circles = []
    for i in np.lexsort((abs(found.turning_rate), found.turning_rate < 0.0)):
        a, b = float(found.pursuer_error[i]), float(found.evader_error[i])
        rate, bearing = float(found.turning_rate[i]), b - game.angle
        reach = 0.5 * pi + game.hysteresis
        if not (game.keeps_side or abs(bearing + 0.5 * pi) < reach):
            continue
        motions = game.angle + a - b
        values = sorted_eigenvalues(modes[i, np.isfinite(modes[i])])
        slowest = values[0].real
        circle = Circle(
            exists=True,
            radius_pursuer_m=vp / abs(rate),
            radius_evader_m=ve / abs(rate),
            distance_m=float(found.distance[i]),
            turning_rate_rad_s=rate,
            headings_apart_rad=abs(wrap_angle(motions - pi)),
            motions_apart_rad=abs(wrap_angle(motions)),
            eigenvalues=values,
            stable=slowest < 0.0,
            time_constant_s=-1.0 / slowest if slowest < 0.0 else inf,
            pursuer_error_rad=a,
            evader_error_rad=b,
            bearing_rad=bearing,
            sliding=bool(found.sliding[i]),
        )
        circles.append(circle)
    return tuple(circles)


def circle_of(game: Game) -> Circle:
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
    """Find the main circle of the game of :func:`.make_game`."""
    return circle_of(make_game(*values, **named))


def sorted_eigenvalues(values: NDArray[Any]) -> tuple[complex, ...]:
    """Return eigenvalues, the slowest (largest real part) first."""
    return tuple(sorted(values.tolist(), key=lambda s: (-s.real, -s.imag)))


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
    found: Array = ve / ke * np.sin(alpha - rate / ke)
    return found + vp / kp * np.sin(rate / kp)


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
    low, high, turn = low[beyond], high[beyond], turn[beyond]
    piece, single = np.nonzero(crosses)
    index = np.concatenate([index[beyond], index[beyond], single])
    low = np.concatenate([low, turn, knots[piece, single]])
    high = np.concatenate([turn, high, knots[piece + 1, single]])
    rate = _bisect(imbalance, games.pick(index), low, high)
    sliding = np.zeros(len(index), dtype=np.bool_)
    return index, rate, rate / games.evader_gain[index], sliding


def _bisect(
    function: Function, games: GameParameters, low: Array, high: Array
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
            b = np.where(np.abs(b) < _ROUNDING, 0.0, b)
            twice = (sign > 0.0) & np.isin(bearing, (0.0, pi))
            rates.append(way * ke)
            errors.append(np.where((way * b >= 0.0) & ~twice, b, np.nan))
            slides.append(np.zeros(count, dtype=np.bool_))
        slow = (slid > 0.0) & (kp * slid < ke * (1.0 - _ROUNDING))
        rates.append(np.where(slow, way * kp * slid, 1.0))
        errors.append(np.where(slow, 0.0, np.nan))
        slides.append(np.ones(count, dtype=np.bool_))
    index = np.tile(np.arange(count), len(rates))
    b = np.concatenate(errors)
    real = np.isfinite(b)
    rate, sliding = np.concatenate(rates), np.concatenate(slides)
    return index[real], rate[real], b[real], sliding[real]
