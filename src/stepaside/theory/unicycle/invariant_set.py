r"""Initial states from which equal players never meet, at any distance.

Equal speeds and gains, proportional laws. No game leaves the diamond
:math:`|a| + |\psi| < \pi`, for any sequence of sides, as long as the
evader's error does not wrap: with
:math:`x = (a + \psi) / 2` and :math:`e = a - \psi`,

.. math::
    \dot e = -k (e - \sigma\alpha), \qquad
    \dot p = k (x + \sigma\alpha / 2) \, p \tan x, \qquad p = r \cos x,

the second of which keeps :math:`p` above :math:`p(0) e^{-kt}`. Proof in
``docs/unicycles.md``.
"""

from math import cos, exp, pi

from ...core.errors import PlanError
from ..laws import side_behind
from .relative_coordinates import RelativeStart
from .unicycle_game import Game


def stays_unwrapped(game: Game, pursuer_error: float, bearing: float) -> bool:
    """Return whether no error of a game between equal players ever wraps.

    Args:
        game: Parameters, with equal speeds and gains, proportional law.
        pursuer_error: Pursuer's error, mirrored to side +1, in [-pi, pi], in
            [rad].
        bearing: Bearing of the pursuer, mirrored to side +1, in [-pi, pi],
            in [rad].

    Returns:
        True where it is proved: inside the diamond, for an evader with the
        side rule "behind" (its error never exceeds the angle), or for one
        that keeps its side at an angle of at most pi / 2 and whose initial
        error is below pi.
    """
    if not abs(pursuer_error) + abs(bearing) < pi:
        return False
    if not game.keeps_side:
        return True
    return game.angle <= 0.5 * pi and bearing < pi - game.angle


def distance_lower_bound(
    game: Game, start: RelativeStart, time: float
) -> float:
    """Return a positive lower bound of the distance at a time.

    Args:
        game: Parameters, with equal speeds and gains, proportional law, an
            angle inside (0, pi), and at most pi / 2 if the side is kept.
        start: Initial state inside the diamond; a kept side is the one
            behind at that state.
        time: Time since the start, in [s].

    Returns:
        r(0) cos((a + psi) / 2) exp(-k t), in [m].

    Raises:
        PlanError: If game or initial state do not satisfy these assumptions.
    """
    _, a, psi = start.wrapped()
    equal = game.pursuer == game.evader and not game.saturated
    side = side_behind(psi)
    if not (equal and stays_unwrapped(game, side * a, side * psi)):
        raise PlanError(
            "the bound needs equal speeds and gains, the proportional law "
            f"and |a| + |psi| < pi [rad], got {game}, {start}"
        )
    fall = exp(-game.evader.gain * time)
    return start.distance * cos(0.5 * (a + psi)) * fall
