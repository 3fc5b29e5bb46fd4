"""How far aside a unicycle gets that somebody walks straight at."""

from math import cos, pi

from ...core.errors import check_not_negative, check_positive

HALF_WIDTHS = 0.55  # of a person and a NAO, arms and all, together, in [m]


def side_step(speed: float, turning: float, time: float) -> float:
    r"""Way to the side of a unicycle that faces whoever comes.

    It turns as fast as it can until it drives across the line of sight:
    :math:`y = \frac{v}{\omega} (1 - \cos \omega t)` until
    :math:`\omega t = \pi / 2`, then straight on.

    Args:
        speed: Driving speed v, in [m/s].
        turning: Greatest turning rate, in [rad/s].
        time: Since it began, in [s].

    Returns:
        Way, in [m].

    Raises:
        PlanError: If an argument is out of its range.
    """
    check_positive(speed, "speed", "m/s")
    check_positive(turning, "turning", "rad/s")
    check_not_negative(time, "time", "s")
    turned = min(turning * time, 0.5 * pi)
    straight = time - turned / turning
    return speed * ((1.0 - cos(turned)) / turning + straight)


def side_clearance(
    speed: float,
    turning: float,
    *,
    person_speed: float,
    distance: float,
    first_step: float,
    half_widths: float = HALF_WIDTHS,
) -> float:
    """Room left beside a person who walks straight at a unicycle.

    Args:
        speed: Driving speed of the unicycle, in [m/s].
        turning: Its greatest turning rate, in [rad/s].
        person_speed: Of the person, in [m/s].
        distance: From which it begins, in [m].
        first_step: Time until it moves, in [s].
        half_widths: Of both together, in [m].

    Returns:
        Room when the person is as far as it was, in [m]; negative if they
        touch.

    Raises:
        PlanError: If an argument is out of its range.
    """
    check_positive(person_speed, "person_speed", "m/s")
    check_not_negative(distance, "distance", "m")
    time = max(0.0, distance / person_speed - first_step)
    return side_step(speed, turning, time) - half_widths
