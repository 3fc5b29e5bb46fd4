r"""Steering laws of the paper, eqs. (2)-(8), for scalars.

Conventions of the whole package: angles are in [rad], positive to the left.
:math:`\psi` is the bearing of the opponent in the player's own frame,
wrapped to :math:`[-\pi, \pi]`. A desired heading :math:`\theta^*` is given
in that same frame, so it is also the heading error of the turning laws. The
side :math:`\sigma = \pm 1` is the sign of the strategy angle :math:`\alpha`
in

.. math:: \theta^* = \psi + \sigma \alpha,

and the sign of both turning rates on the limit circle (+1:
counter-clockwise). Eq. (5) as printed is :math:`\alpha = \pi / 2` with
:math:`\sigma = 1`; the text before it defines the normal *behind* the
evader, which is :math:`\sigma = -\mathrm{sign}\, \psi`. With the
generalisation as printed, :math:`\theta_{eva} = \theta_{aim} - \alpha`, an
evader that walks backward would meet its pursuer at :math:`\alpha = 0`; with
the law above it faces the pursuer and walks away.

The functions use arithmetic only, so that Numba can compile them.
"""

from math import pi, tau


def wrap_once(angle: float) -> float:
    """Wrap an angle that is less than a turn beyond [-pi, pi].

    The result equals :func:`stepaside.core.poses.wrap_angle` bit by bit,
    except for odd multiples of pi, which may keep either sign.
    """
    if angle > pi:
        return angle - tau
    if angle < -pi:
        return angle + tau
    return angle


def pursuit_heading(bearing: float) -> float:
    """Return the desired heading of the pursuer, the bearing itself, (2)."""
    return bearing


def evasion_heading(bearing: float, side: int, angle: float) -> float:
    """Return the desired heading of the evader, which drives backward, (5).

    Args:
        bearing: Bearing of the pursuer in the evader's frame, in [-pi, pi],
            in [rad].
        side: +1 or -1.
        angle: Strategy angle alpha in [0, pi], in [rad]: pi/2 moves aside, 0
            moves back.

    Returns:
        Heading in the evader's frame, in [-pi, pi], in [rad].
    """
    return wrap_once(bearing + side * angle)


def side_behind(bearing: float) -> int:
    """Return the side, +1 or -1, whose normal lies behind (Sec. II-B).

    At bearings 0 and pi neither normal is behind; at 0 the result is the
    side of (5) as printed. The bearing is that of the pursuer in the
    evader's frame, in [-pi, pi], in [rad].
    """
    return -1 if bearing > 0.0 else 1


def update_side(side: int, bearing: float, hysteresis: float) -> int:
    """Update the side of the evader, +1 or -1, with hysteresis.

    The side changes only when the pursuer is clearly on the other side, so
    that noise does not flip it, neither at bearing 0 nor where the bearing
    wraps.

    Args:
        side: Current side; 0 if none has been chosen.
        bearing: As in :func:`side_behind`.
        hysteresis: Least angle past 0 and short of pi at which the side
            changes, in [rad]; from pi/2 on it never does.
    """
    if side == 0:
        return side_behind(bearing)
    past = side * bearing
    return -side if hysteresis < past < pi - hysteresis else side


def proportional_rate(error: float, gain: float) -> float:
    """Return the turning rate of (2), (4) and (8), k times the error."""
    return gain * error


def saturated_rate(error: float, gain: float) -> float:
    """Return the turning rate of (6), of magnitude k, in [rad/s]."""
    if error > 0.0:
        return gain
    return -gain if error < 0.0 else 0.0


def is_evading(
    evading: bool, distance: float, safety_radius: float, release: float
) -> bool:
    """Return whether to evade, latched between trigger and release distance.

    The distance on the limit circle may exceed the safety radius (Sec. IV:
    0.9 m against 0.8 m); without the latch an evader would stop and start
    on it. Distances are in [m].
    """
    return distance < (release if evading else safety_radius)
