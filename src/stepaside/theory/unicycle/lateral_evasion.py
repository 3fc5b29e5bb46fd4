"""Lateral displacement of a unicycle that avoids an approaching person."""

from math import cos, pi

HALF_WIDTHS = 0.55  # sum for a person and a NAO, with arms, in [m]


def lateral_displacement(speed: float, turning: float, time: float) -> float:
    r"""Return the lateral displacement, in [m], of a unicycle moving aside.

    It faces the person first and turns at its full rate until it drives
    across the line of sight: :math:`y = \frac{v}{\omega} (1 - \cos \omega
    t)` until :math:`\omega t = \pi / 2`, then straight.
    """
    turned = min(turning * time, 0.5 * pi)
    straight = time - turned / turning
    return speed * ((1.0 - cos(turned)) / turning + straight)


def lateral_clearance(
    speed: float,
    turning: float,
    *,
    person_speed: float,
    distance: float,
    first_step: float,
) -> float:
    """Return the clearance to a person who walks straight at a unicycle.

    Args:
        speed: Driving speed of the unicycle, in [m/s].
        turning: Largest turning rate of the unicycle, in [rad/s].
        person_speed: Speed of the person, in [m/s].
        distance: Distance at which the unicycle reacts, in [m].
        first_step: Time until it moves, in [s].

    Returns:
        Clearance when the person passes the initial position of the
        unicycle, in [m]; negative for a contact.
    """
    time = max(0.0, distance / person_speed - first_step)
    return lateral_displacement(speed, turning, time) - HALF_WIDTHS
