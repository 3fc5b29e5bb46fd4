"""Parameters of a game as plain numbers, for compiled loops."""

from typing import NamedTuple

from .unicycle_game import Game


class FlatParameters(NamedTuple):
    """Constants of a game.

    Attributes:
        pursuer_speed: Speed of the pursuer, in [m/s].
        evader_speed: Speed of the evader, in [m/s].
        pursuer_gain: Gain of the pursuer, in [1/s].
        evader_gain: Gain of the evader, in [1/s]; saturated, its turning
            rate, in [rad/s].
        angle: Evasion angle, in [rad].
        hysteresis: Angle of the pursuer beyond the evader's axis at which
            the side changes, in [rad].
        keeps_side: Whether the side never changes.
        saturated: Whether the evader turns by (6) rather than by (4).
        capture_distance: Distance at which a game ends, in [m].
    """

    pursuer_speed: float
    evader_speed: float
    pursuer_gain: float
    evader_gain: float
    angle: float
    hysteresis: float
    keeps_side: bool
    saturated: bool
    capture_distance: float


def flat_parameters(game: Game, capture_distance: float) -> FlatParameters:
    """Return the parameters of a game and its capture distance as numbers."""
    return FlatParameters(
        pursuer_speed=float(game.pursuer.speed),
        evader_speed=float(game.evader.speed),
        pursuer_gain=float(game.pursuer.gain),
        evader_gain=float(game.evader.gain),
        angle=float(game.angle),
        hysteresis=float(game.hysteresis),
        keeps_side=game.keeps_side,
        saturated=game.saturated,
        capture_distance=float(capture_distance),
    )
