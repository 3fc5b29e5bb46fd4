"""Which maneuvers are tried, and what makes one good."""

from math import inf, pi
from typing import Any, NamedTuple

DEEPEST = 8  # pieces of a maneuver


class CandidateManeuvers(NamedTuple):
    """Which maneuvers are tried.

    Attributes:
        pieces: Steps of each piece, the first first. Shape (n,).
        turns: Turns of a step that each may have, in [rad], those that are
            preferred first. Shape (m,).
        horizon: Steps of a whole maneuver, law included, but for those
            on the spot.
        angle: Strategy alpha of the law, in [rad].
        spots: Most steps that turn on the spot, by the largest turn, before
            the first piece; every second number up to it is tried.
        still: Share of its stride that a step on the spot makes.
        most: Steps that are rolled out, after which no other maneuver is
            begun: what bounds the time of a decision.
    """

    pieces: Any
    turns: Any
    horizon: int
    angle: float = pi / 2
    spots: int = 0
    still: float = 0.05
    most: int = 40_000


class ManeuverObjective(NamedTuple):
    """What makes a maneuver good.

    Attributes:
        enough: Distance to the pursuer that is as good as any larger, [m].
        clearance: Least distance of the own centre to solids, in [m].
        penalty: What a metre less than that costs, in [m].
        sight: Largest bearing at which the pursuer is still seen, in [rad].
        blindness: What a radian beyond that costs, in [m].
        gain: By how much a maneuver must beat the present one, in [m].
        tight: Score below which turning on the spot is tried as well, [m].
    """

    enough: float = inf
    clearance: float = 0.2
    penalty: float = 5.0
    sight: float = inf
    blindness: float = 0.1
    gain: float = 1e-6
    tight: float = -inf


class BestManeuver(NamedTuple):
    """The best maneuver.

    Attributes:
        score: In [m].
        turns: Turn of each step to come, in [rad], the law's included.
            Shape (horizon + spot,).
        steps: Steps that were rolled out to find it.
        spot: How many of the first turns are made on the spot.
    """

    score: float
    turns: Any
    steps: int
    spot: int = 0
