r"""Starts from which equal players never meet, at whatever distance.

Equal speeds and gains, proportional laws. No game leaves the diamond
:math:`|a| + |\psi| < \pi`, whichever side the evader takes and however often
it changes, as long as its error does not wrap: with
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
    """Whether no error of a game between equal players ever wraps.

    Args:
        game: Parameters; equal speeds and gains, proportional law.
        pursuer_error: Seen at side +1, in [-pi, pi], in [rad].
        bearing: Seen at side +1, in [-pi, pi], in [rad].

    Returns:
        True where it is proved: inside the diamond, with an evader behind
        whose back the side is (its error is then never above the angle), or
        one that keeps its side at an angle of pi / 2 at most and whose
        error is not beyond pi at the start.
    """
    if not abs(pursuer_error) + abs(bearing) < pi:
        return False
    if not game.keeps_side:
        return True
    return game.angle <= 0.5 * pi and bearing < pi - game.angle


def least_distance(game: Game, start: RelativeStart, time: float) -> float:
    """Lower bound of the distance at a time; it is above zero.

    Args:
        game: Parameters; equal speeds and gains, proportional law, an angle
            inside (0, pi), and at most pi / 2 where the side is kept.
        start: Inside the diamond; a kept side is the one behind there.
        time: Since the start, in [s].

    Returns:
        r(0) cos((a + psi) / 2) exp(-k t), in [m].

    Raises:
        PlanError: If the game or the start is not of that kind.
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
