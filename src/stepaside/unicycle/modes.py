r"""Pieces on which the laws are smooth, and how one leads to the next.

In relative coordinates :math:`(r, a, \psi)` the laws jump where a wrapped
error passes :math:`\pm\pi`, where the evader changes side, and, saturated,
where its error changes sign. Between those places

.. math:: \dot\psi = (1 - c_2) \Omega - c_1 \psi - c_0,
    \qquad \psi \in [\text{low}, \text{high}].

The functions take and return plain numbers and call no other, so that they
can be compiled as they are.
"""

from math import inf, pi

PROPORTIONAL = 0  # branch of eq. (4)
LEFT = 1  # branches of eq. (6): full rate to the left,
RIGHT = -1  # to the right,
SLIDING = 2  # and what Filippov's rule gives between the two


def piece(
    side: int,
    branch: int,
    angle: float,
    hysteresis: float,
    keeps_side: bool,
    gain: float,
) -> tuple[float, float, float, float, float]:
    """Give (low, high, c0, c1, c2) of a piece; see the module."""
    zero = -side * angle  # bearing at which the evader's error is zero
    if branch == 2:
        return -inf, inf, 0.0, 0.0, 1.0
    if keeps_side:
        low, high = zero - pi, zero + pi
    elif side < 0:
        low, high = -hysteresis, pi + hysteresis
    else:
        low, high = -pi - hysteresis, hysteresis
    if branch == 0:
        return low, high, -gain * zero, gain, 0.0
    if branch > 0:
        return zero, high, gain, 0.0, 0.0
    return low, zero, -gain, 0.0, 0.0


def enter(
    bearing: float,
    sight_rate: float,
    side: int,
    angle: float,
    keeps_side: bool,
    saturated: bool,
    gain: float,
) -> tuple[float, int, int]:
    """Find the piece that a game starts in.

    Args:
        bearing: Bearing of the pursuer, in [-pi, pi], in [rad].
        sight_rate: Rate of the line of sight, in [rad/s].
        side: +1 or -1, or 0 for the side behind the evader.
        angle: Evasion angle, in [rad].
        keeps_side: Whether the side never changes.
        saturated: Whether the evader turns by (6).
        gain: Gain of the evader, in [1/s].

    Returns:
        Bearing (a whole turn away from the given one at most), side, branch.
    """
    if side == 0:
        side = -1 if bearing > 0.0 else 1
    error = bearing + side * angle
    if keeps_side:
        if error > pi:
            error -= 2.0 * pi
        elif error < -pi:
            error += 2.0 * pi
    branch = 0
    if saturated:
        if error > 0.0:
            branch = 1
        elif error < 0.0:
            branch = -1
        elif abs(sight_rate) <= gain:
            branch = 2
        else:
            branch = 1 if sight_rate > 0.0 else -1
    return error - side * angle, side, branch


def leave(
    bearing: float,
    sight_rate: float,
    side: int,
    branch: int,
    edge: int,
    angle: float,
    keeps_side: bool,
    gain: float,
) -> tuple[float, int, int]:
    """Find the piece that follows when a game leaves its piece.

    Args:
        bearing: Bearing of the pursuer at that instant, in [rad].
        sight_rate: Rate of the line of sight, in [rad/s].
        side: Side of the piece left.
        branch: Branch of the piece left.
        edge: -1 at its low bearing, +1 at its high one; of no meaning when
            sliding, which ends where the line of sight outruns the evader.
        angle: Evasion angle, in [rad].
        keeps_side: Whether the side never changes.
        gain: Gain of the evader, in [1/s].

    Returns:
        Bearing, side and branch on the next piece.
    """
    zero = -side * angle
    if branch == 2:
        return zero, side, (1 if sight_rate > 0.0 else -1)
    if branch == -edge:  # the saturated evader's error is zero
        if abs(sight_rate) <= gain:
            return zero, side, 2
        return zero, side, -branch
    if keeps_side:
        return bearing - edge * 2.0 * pi, side, -branch
    if edge * side < 0:  # the pursuer passes behind the evader's back
        bearing -= edge * 2.0 * pi
    side = -side
    if branch != 0:
        branch = 1 if bearing + side * angle > 0.0 else -1
    return bearing, side, branch
