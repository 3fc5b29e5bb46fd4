"""Candidate maneuvers of the search, and the objective that ranks them."""

from math import inf, pi
from typing import Any, NamedTuple

DEEPEST = 8  # most pieces of a maneuver, plus one


class CandidateManeuvers(NamedTuple):
    """Set of maneuvers that the search tries.

    Attributes:
        pieces: Number of steps of each piece, in order. Shape (n,).
        turns: Turns per step that are tried in each piece, in [rad], the
            preferred ones first. Shape (m,).
        horizon: Number of steps of a maneuver, law included, without those
            on the spot.
        angle: Strategy alpha of the law, in [rad].
        spots: Largest number of steps that turn on the spot, by the largest
            turn, before the first piece; every second number is tried.
        still: Fraction of the stride that a step on the spot makes.
        most: Number of rolled-out steps after which no further maneuver is
            begun, which bounds the time of a decision.
    """

    pieces: Any
    turns: Any
    horizon: int
    angle: float = pi / 2
    spots: int = 0
    still: float = 0.05
    most: int = 40_000


class ManeuverObjective(NamedTuple):
    """Objective of the search.

    Attributes:
        enough: Distance to the pursuer beyond which no more is gained, [m].
        clearance: Required clearance of the own centre, in [m].
        penalty: Cost of missing clearance, in [m] per [m].
        sight: Largest bearing at which the pursuer is visible, in [rad].
        blindness: Cost of a bearing beyond that, in [m] per [rad].
        gain: Improvement over the present maneuver that replaces it, in [m].
        tight: Score below which turns on the spot are tried as well, [m].
    """

    enough: float = inf
    clearance: float = 0.2
    penalty: float = 5.0
    sight: float = inf
    blindness: float = 0.1
    gain: float = 1e-6
    tight: float = -inf


class BestManeuver(NamedTuple):
    """Result of the search.

    Attributes:
        score: Score of the maneuver, in [m].
        turns: Turn of each of its steps, in [rad], those of the law
            included. Shape (horizon + spot,).
        steps: Number of steps that the search rolled out.
        spot: Number of initial steps that turn on the spot.
    """

    score: float
    turns: Any
    steps: int
    spot: int = 0
