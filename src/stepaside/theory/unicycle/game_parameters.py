"""The parameters of a game as plain numbers, for loops and compilers."""

from typing import NamedTuple

from .unicycle_game import Game


class FlatParameters(NamedTuple):
    """What stays the same during a game.

    Attributes:
        pursuer_speed: In [m/s].
        evader_speed: In [m/s].
        pursuer_gain: In [1/s].
        evader_gain: In [1/s]; saturated, the turning rate in [rad/s].
        angle: Evasion angle, in [rad].
        hysteresis: How far beyond the evader's axis the pursuer's bearing
            is when the side changes, in [rad].
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


def rules_of(game: Game, capture_distance: float) -> FlatParameters:
    """Write a game's parameters, and the distance that ends it, as numbers."""
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
