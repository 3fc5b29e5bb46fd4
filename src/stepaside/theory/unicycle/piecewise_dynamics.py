r"""Smooth pieces of the laws, and transitions between them.

In relative coordinates :math:`(r, a, \psi)` the laws are discontinuous where
a wrapped error passes :math:`\pm\pi`, where the evader changes side, and,
saturated, where its error changes sign. Between these discontinuities

.. math:: \dot\psi = f \Omega - c_1 \psi - c_0,
    \qquad \psi \in [\text{low}, \text{high}].

The functions take and return numbers, so that Numba can compile them.
"""

from enum import IntEnum
from math import inf, pi
from typing import Any, NamedTuple

from ...core.compilation import inlined
from .. import laws
from .game_parameters import FlatParameters

inlined(laws.wrap_once)  # called by evasion_heading
evasion_heading = inlined(laws.evasion_heading)
proportional_rate = inlined(laws.proportional_rate)
saturated_rate = inlined(laws.saturated_rate)
side_behind = inlined(laws.side_behind)


class Branch(IntEnum):
    """Branch of the evader's turning law."""

    PROPORTIONAL = 0  # eq. (4)
    LEFT = 1  # eq. (6), full rate to the left
    RIGHT = 2  # eq. (6), full rate to the right
    SLIDING = 3  # eq. (6), zero error by Filippov's rule


class Edge(IntEnum):
    """End of the range of bearings of a smooth piece."""

    LOW = -1
    HIGH = 1


class Mode(NamedTuple):
    """Discrete state that identifies a smooth piece.

    Attributes:
        side: Side of the line of sight that the evader takes, +1 or -1.
        branch: Branch of its turning law.
    """

    side: int
    branch: Branch


class SmoothPiece(NamedTuple):
    """Coefficients of a smooth piece, or of the pieces of many games.

    Attributes:
        low: Least bearing, in [rad].
        high: Largest bearing, in [rad].
        constant: Turning rate of the evader at bearing zero, in [rad/s].
        slope: Derivative of the turning rate by the bearing, in [1/s].
        free: 0 if the evader turns with the line of sight, else 1.
    """

    low: Any
    high: Any
    constant: Any
    slope: Any
    free: Any


@inlined
def branch_from_code(code: int) -> Branch:
    """Return the branch of a number, as stored in arrays."""
    if code == 0:
        return Branch.PROPORTIONAL
    if code == 1:
        return Branch.LEFT
    if code == 2:
        return Branch.RIGHT
    return Branch.SLIDING


@inlined
def branch_towards(amount: float) -> Branch:
    """Return the branch that turns in the direction of a sign."""
    return Branch.LEFT if amount > 0.0 else Branch.RIGHT


@inlined
def opposite_branch(branch: Branch) -> Branch:
    """Return the branch with the opposite turning rate."""
    if branch == Branch.LEFT:
        return Branch.RIGHT
    if branch == Branch.RIGHT:
        return Branch.LEFT
    return branch


@inlined
def piece_of(mode: Mode, rules: FlatParameters) -> SmoothPiece:
    """Return the coefficients of a smooth piece."""
    gain, width = rules.evader_gain, rules.hysteresis
    zero = -mode.side * rules.angle  # bearing of zero error
    if mode.branch == Branch.SLIDING:
        return SmoothPiece(-inf, inf, 0.0, 0.0, 0.0)
    if rules.keeps_side:
        low, high = zero - pi, zero + pi
    elif mode.side < 0:
        low, high = -width, pi + width
    else:
        low, high = -pi - width, width
    if mode.branch == Branch.PROPORTIONAL:
        constant = proportional_rate(-zero, gain)
        slope = proportional_rate(1.0, gain)
        return SmoothPiece(low, high, constant, slope, 1.0)
    if mode.branch == Branch.LEFT:
        return SmoothPiece(zero, high, saturated_rate(1.0, gain), 0.0, 1.0)
    return SmoothPiece(low, zero, saturated_rate(-1.0, gain), 0.0, 1.0)


@inlined
def initial_mode(
    bearing: float, sight_rate: float, side: int, rules: FlatParameters
) -> tuple[float, Mode]:
    """Return the initial mode of a game.

    Args:
        bearing: Bearing of the pursuer, in [-pi, pi], in [rad].
        sight_rate: Turning rate of the line of sight, in [rad/s].
        side: +1 or -1, or 0 for the side behind the evader.
        rules: Rules of the game.

    Returns:
        Bearing, up to a whole turn away from the given one, and the mode.
    """
    if side == 0:
        side = side_behind(bearing)
    error = bearing + side * rules.angle
    if rules.keeps_side:
        error = evasion_heading(bearing, side, rules.angle)
    branch = Branch.PROPORTIONAL
    if rules.saturated:
        if error != 0.0:
            branch = branch_towards(error)
        elif abs(sight_rate) <= rules.evader_gain:
            branch = Branch.SLIDING
        else:
            branch = branch_towards(sight_rate)
    return error - side * rules.angle, Mode(side, branch)


@inlined
def next_mode(
    bearing: float,
    sight_rate: float,
    mode: Mode,
    edge: Edge,
    rules: FlatParameters,
) -> tuple[float, Mode]:
    """Return the mode after a game crosses an edge of its smooth piece.

    Args:
        bearing: Bearing of the pursuer at the edge, in [rad].
        sight_rate: Turning rate of the line of sight, in [rad/s].
        mode: Mode before the transition.
        edge: Edge that is crossed; ignored when sliding, which ends where
            the line of sight turns faster than the evader can.
        rules: Rules of the game.

    Returns:
        Bearing and mode on the next piece.
    """
    side, branch = mode.side, mode.branch
    zero = -side * rules.angle
    if branch == Branch.SLIDING:
        return zero, Mode(side, branch_towards(sight_rate))
    falls = branch == Branch.LEFT and edge == Edge.LOW
    if falls or (branch == Branch.RIGHT and edge == Edge.HIGH):
        # The saturated evader's error is zero.
        if abs(sight_rate) <= rules.evader_gain:
            return zero, Mode(side, Branch.SLIDING)
        return zero, Mode(side, opposite_branch(branch))
    turned = bearing - (2.0 * pi if edge == Edge.HIGH else -2.0 * pi)
    if rules.keeps_side:
        return turned, Mode(side, opposite_branch(branch))
    if (edge == Edge.HIGH) == (side < 0):
        bearing = turned  # the pursuer passes behind the evader's back
    side = -side
    if branch != Branch.PROPORTIONAL:
        branch = branch_towards(bearing + side * rules.angle)
    return bearing, Mode(side, branch)
