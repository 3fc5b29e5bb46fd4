r"""The laws of the paper, once: scalars in, scalars out.

Conventions, here and everywhere else. Angles are in [rad], positive to the
left. :math:`\psi` is the bearing of the other player in the frame of the
one who decides, wrapped to :math:`[-\pi, \pi]`. A desired heading
:math:`\theta^*` is given in that same frame, so it is the error by which the
turning laws turn. The side :math:`\sigma = \pm 1` is the sign with which
the strategy angle :math:`\alpha` enters,

.. math:: \theta^* = \psi + \sigma \alpha,

and the sign of both turning rates on the circle that the players end on
(+1: counter-clockwise). Eq. (5) as printed is :math:`\alpha = \pi / 2` with
:math:`\sigma = 1`; the words before it ask for the normal *behind* the
evader, which is :math:`\sigma = -\mathrm{sign}\, \psi`. The generalisation
as printed, :math:`\theta_{eva} = \theta_{aim} - \alpha`, would have an
evader that walks backward meet its pursuer at :math:`\alpha = 0`; with the
law above it faces the pursuer and walks away.

The functions use nothing but arithmetic, so that they can be compiled as
they are.
"""

from math import pi, tau


def wrap_once(angle: float) -> float:
    """Wrap an angle that is less than a turn beyond [-pi, pi].

    To the bit what :func:`stepaside.core.poses.wrap_angle` gives, but for odd
    multiples of pi, which may keep either sign.
    """
    if angle > pi:
        return angle - tau
    if angle < -pi:
        return angle + tau
    return angle


def pursuit_heading(bearing: float) -> float:
    """Desired heading of the pursuer, theta* = theta_aim, eq. (2).

    Args:
        bearing: Of the evader, in [rad].
    """
    return bearing


def evasion_heading(bearing: float, side: int, angle: float) -> float:
    """Desired heading of the evader, which drives backward, eq. (5).

    Args:
        bearing: Of the pursuer, in [-pi, pi], in [rad].
        side: +1 or -1.
        angle: Strategy alpha, in [0, pi], in [rad]: pi/2 moves aside, 0
            moves back.

    Returns:
        Heading, in [-pi, pi], in [rad].
    """
    return wrap_once(bearing + side * angle)


def side_behind(bearing: float) -> int:
    """Side whose normal lies behind the evader (Sec. II-B).

    Straight ahead (and at pi, which is straight behind) both normals lie
    alike; straight ahead it is that of (5) as printed.

    Args:
        bearing: Of the pursuer, in [-pi, pi], in [rad].
    """
    return -1 if bearing > 0.0 else 1


def keep_side(side: int, bearing: float, hysteresis: float) -> int:
    """Side of an evader that has one already, or of one that has none.

    The side is kept until the pursuer is seen clearly on the other one, so
    that noise does not flip it, neither ahead nor where the bearing wraps.

    Args:
        side: Side until now, +1 or -1; 0 for none.
        bearing: Of the pursuer, in [-pi, pi], in [rad].
        hysteresis: How far it must be past 0, or short of pi, for the side
            to change, in [rad]; from pi/2 on it never does.
    """
    if side == 0:
        return side_behind(bearing)
    past = side * bearing
    return -side if hysteresis < past < pi - hysteresis else side


def proportional_rate(error: float, gain: float) -> float:
    """Turning rate of (2), (4) and (8), in [rad/s].

    Args:
        error: Desired heading in the own frame, in [rad].
        gain: Steering gain k, in [1/s].
    """
    return gain * error


def saturated_rate(error: float, gain: float) -> float:
    """Turning rate of (6), in [rad/s].

    Args:
        error: Desired heading in the own frame, in [rad].
        gain: Turning rate k itself, in [rad/s].
    """
    if error > 0.0:
        return gain
    return -gain if error < 0.0 else 0.0


def is_evading(
    evading: bool, distance: float, safety_radius: float, release: float
) -> bool:
    """Latch evasion between the safety radius and a release distance.

    The circle that the players end on may be wider than the safety area
    (Sec. IV: 0.9 m against 0.8 m); without the latch an evader would stop
    and start on it.

    Args:
        evading: Whether it evades already.
        distance: To the pursuer, in [m].
        safety_radius: Distance below which evasion begins, in [m].
        release: Distance from which on it ends, in [m].
    """
    return distance < (release if evading else safety_radius)
