"""All circles of a game, the main one and the reversed."""

from math import pi

from .circle_equations import Circle, circle_of, describe_circle
from .equilibria import GameParameters, find_rests
from .unicycle_game import Game, make_game, with_values

_SAME = 1e-9  # relative difference of the rates of one and the same circle


def circles_of(game: Game) -> tuple[Circle, ...]:
    r"""Find every rest of the relative motion that agrees with the side rule.

    All are given for side +1 with errors in :math:`(-\pi, \pi]`; side -1 has
    their mirror images. Under ``BEHIND`` the pursuer's bearing has to lie
    behind its axis, by less than the hysteresis beyond it; an evader that
    keeps its side has those circles and possibly others, which
    ``Circle.behind`` tells apart. At angles 0 and pi both sides are one and
    a circle and its mirror image both appear.

    Args:
        game: Parameters of the game.

    Returns:
        The main circle first, if there is one, then those that turn its way
        round, then the reversed ones, each group the slowest first.
    """
    values = GameParameters.of(
        game.pursuer.speed,
        game.evader.speed,
        game.pursuer.gain,
        game.evader.gain,
        game.angle,
    )
    rests = find_rests(values, saturated=game.saturated)
    main = circle_of(game)
    found = [main] if main.exists else []
    rows = zip(
        rests.turning_rate.tolist(),
        rests.pursuer_error.tolist(),
        rests.evader_error.tolist(),
        rests.sliding.tolist(),
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
"""The same of the values that :func:`.laws.make_game` takes."""


def agrees(game: Game, circle: Circle) -> bool:
    """Whether the side rule of a game leaves it on a circle."""
    if game.keeps_side:
        return True
    slack = game.hysteresis
    middle = -0.5 * pi
    return abs(circle.bearing_rad - middle) < 0.5 * pi + slack


def _is_main(main: Circle, circle: Circle) -> bool:
    """Whether a circle is the one that is listed first already."""
    if not main.exists or main.sliding != circle.sliding:
        return False
    difference = abs(main.turning_rate_rad_s - circle.turning_rate_rad_s)
    near = difference < _SAME * main.turning_rate_rad_s
    return near and abs(main.bearing_rad - circle.bearing_rad) < 1e-6
