"""Which maneuvers are tried, and what makes one good."""

from math import inf, pi
from typing import Any, NamedTuple

DEEPEST = 8  # pieces of a maneuver


class Maneuvers(NamedTuple):
    """Which maneuvers are tried.

    Attributes:
        pieces: Steps of each piece, the first first. Shape (n,).
        turns: Turns of a step that each may have, in [rad], those that are
            preferred first. Shape (m,).
        horizon: Steps of a whole maneuver, law included.
        angle: Strategy alpha of the law, in [rad].
    """

    pieces: Any
    turns: Any
    horizon: int
    angle: float = pi / 2


class Aims(NamedTuple):
    """What makes a maneuver good.

    Attributes:
        enough: Distance to the pursuer that is as good as any larger, [m].
        clearance: Least distance of the own centre to solids, in [m].
        penalty: What a metre less than that costs, in [m].
        sight: Largest bearing at which the pursuer is still seen, in [rad].
        blindness: What a radian beyond that costs, in [m].
        gain: By how much a maneuver must beat the present one, in [m].
    """

    enough: float = inf
    clearance: float = 0.2
    penalty: float = 5.0
    sight: float = inf
    blindness: float = 0.1
    gain: float = 1e-6


class Found(NamedTuple):
    """The best maneuver.

    Attributes:
        score: In [m].
        turns: Turn of each step to come, in [rad], the law's included.
            Shape (horizon,).
        steps: Steps that were rolled out to find it.
    """

    score: float
    turns: Any
    steps: int
