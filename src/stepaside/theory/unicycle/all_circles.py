"""All limit circles of a game: the main circle and the reversed ones."""

from math import pi

from .circle_equations import Circle, circle_of, describe_circle
from .equilibria import GameParameters, find_equilibria
from .unicycle_game import Game, make_game, with_values

_SAME = 1e-9  # relative difference below which turning rates are equal


def circles_of(game: Game) -> tuple[Circle, ...]:
    r"""Find all equilibria of the relative motion allowed by the side rule.

    Circles are given for side +1, with errors in :math:`(-\pi, \pi]`; side
    -1 has their mirror images. Under ``BEHIND`` side +1 must be the side
    behind the evader, up to the hysteresis. An evader that keeps its side
    has those circles and possibly others, which ``Circle.behind``
    distinguishes. At angles 0 and pi both sides coincide, and a circle and
    its mirror image both appear.

    Args:
        game: Parameters of the game.

    Returns:
        The main circle first, if it exists, then those with the same sense
        of rotation, then the reversed ones; slowest first in each group.
    """
    values = GameParameters.of(
        game.pursuer.speed,
        game.evader.speed,
        game.pursuer.gain,
        game.evader.gain,
        game.angle,
    )
    equilibria = find_equilibria(values, saturated=game.saturated)
    main = circle_of(game)
    found = [main] if main.exists else []
    rows = zip(
        equilibria.turning_rate.tolist(),
        equilibria.pursuer_error.tolist(),
        equilibria.evader_error.tolist(),
        equilibria.sliding.tolist(),
        strict=True,
    )
    for rate, a, b, sliding in sorted(
        rows, key=lambda r: (r[0] < 0, abs(r[0]))
    ):
        circle = describe_circle(game, rate, a, b, sliding=sliding)
        if agrees(game, circle) and not _is_main(main, circle):
            found.append(circle)
    return tuple(found)


find_circles = with_values("find_circles", make_game, circles_of)
"""Variant of :func:`circles_of` with the parameters of ``make_game``."""


def agrees(game: Game, circle: Circle) -> bool:
    """Return whether the side rule of a game is consistent with a circle."""
    if game.keeps_side:
        return True
    slack = game.hysteresis
    middle = -0.5 * pi
    return abs(circle.bearing_rad - middle) < 0.5 * pi + slack


def _is_main(main: Circle, circle: Circle) -> bool:
    """Return whether a circle is the main circle."""
    if not main.exists or main.sliding != circle.sliding:
        return False
    difference = abs(main.turning_rate_rad_s - circle.turning_rate_rad_s)
    near = difference < _SAME * main.turning_rate_rad_s
    return near and abs(main.bearing_rad - circle.bearing_rad) < 1e-6
