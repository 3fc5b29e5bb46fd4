"""Try maneuvers in the mind, and begin the best of them."""

from dataclasses import dataclass
from functools import lru_cache
from math import cos, inf, pi, radians, sin
from typing import NamedTuple

import numpy as np

from ..arena import NO_OBSTACLES, obstacle_set
from ..core.errors import (
    ConfigurationError,
    check_not_negative,
    check_positive,
    check_within,
)
from ..core.poses import Pose
from ..planning import Direction
from .bound_cache import pursuit_table
from .knowledge import ON_THE_SPOT, STAND, Intent, Knowledge, Limits
from .opponent_track import Trace, note, pursuer_heading
from .search import (
    NO_VALUE,
    CandidateManeuvers,
    ManeuverObjective,
    PlayerPair,
    StepRules,
)
from .search.candidate_maneuvers import DEEPEST
from .search.packed_obstacles import clearance_at
from .search.step_motion import half_turn, step_both


def place_both(trace: Trace, heading: float) -> PlayerPair:
    """Where both are, in the own odometry.

    Args:
        trace: At least one sighting.
        heading: Of the pursuer there, in [rad].
    """
    seen = trace[-1]
    return PlayerPair(
        seen.own_x,
        seen.own_y,
        cos(seen.own_theta),
        sin(seen.own_theta),
        seen.x,
        seen.y,
        cos(heading),
        sin(heading),
    )


def moved_on(
    both: PlayerPair, knowledge: Knowledge, begins: Pose
) -> PlayerPair:
    """Where both are when the step begins that is decided.

    A body passes the foot that landed half a step after it did, and the
    pursuer has gone on as long.

    Args:
        both: Where they were when the pursuer was seen.
        knowledge: Of the own limits, and how long ago that was.
        begins: Where the step begins, in the own odometry.
    """
    limits = knowledge.limits
    steps = 0.5 + knowledge.age / limits.step_duration
    way = limits.stride * steps
    return PlayerPair(
        begins.x,
        begins.y,
        cos(begins.theta),
        sin(begins.theta),
        both.px + way * both.pc,
        both.py + way * both.ps,
        both.pc,
        both.ps,
    )


ERROR = ConfigurationError
MARGIN = 0.005  # beyond the clearance that is asked for, in [m]
PENALTY = 60.0  # of a metre too near: a centimetre is worth 0.6 m
WORTH = 0.5  # of as much too near as a map may be off, in [m]
SPOTS = 12  # steps on the spot: half a turn is 12.5 of the sharpest
LONGEST = 400  # steps of a maneuver
GAIN = 1e-6  # by which a maneuver must beat the present one, in [m]
OPEN = 3  # pieces that are enough where a table says what comes after


class LookAheadMemory(NamedTuple):
    """What an evader that looks ahead remembers.

    Attributes:
        evading: Whether it evades.
        trace: Where the pursuer was seen.
        plan: Turns of steps that it would make, in [rad].
        planned: When the first of them would be made, in [s].
        spot: How many of the first would be made on the spot.
    """

    evading: bool = False
    trace: Trace = ()
    plan: tuple[float, ...] = ()
    planned: float = 0.0
    spot: int = 0

    def rest(self, time: float, step: float) -> tuple[tuple[float, ...], int]:
        """What is left of the plan, for steps of a duration.

        Returns:
            Turns, and how many of the first of them are made on the spot.
        """
        made = max(0, round((time - self.planned) / step))
        return self.plan[made:], max(0, self.spot - made)


@dataclass(frozen=True, slots=True)
class LookAhead:
    """Roll maneuvers out against a model of the pursuer, and take the best.

    A maneuver is a sequence of pieces with a constant turn each, then the
    paper's law for a while. It is good if the pursuer never comes near,
    nothing is touched and the pursuer stays in sight. Without pieces, and
    with nothing on the floor, it is the paper's law. Where a map may be
    off, what it says changes from step to step: then a plan is kept until
    another is better by as much, and to come too near costs less.

    Attributes:
        pieces: Steps of each piece.
        turns: How many turns each may have, evenly up to the largest.
        tail: Steps of the law after them.
        angle: Strategy alpha of the law, in [rad].
        enough: Distance to the pursuer that is as good as any larger where
            something stands around, in [m]; on an open floor more is better.
        body_radius: Least distance of the own centre to solids, in [m].
        largest_error: Largest desired heading, in [rad]; pi is the most of
            the paper's law.
        sight: Largest bearing at which the head sees the pursuer, in [rad].
        lead: How far ahead the pursuer is thought to aim; see
            :class:`~stepaside.strategies.search.StepRules`.
        safety_radius: Distance at which it begins, in [m].
        tight: Distance to the pursuer below which it also tries to turn on
            the spot first, where something stands around, in [m].
        cells: Of the table that says, on an open floor, what comes after
            the last piece; 0 for none, but the law.
    """

    pieces: tuple[int, ...] = (2, 4, 8, 12, 16)
    turns: int = 7
    tail: int = 10
    angle: float = pi / 2
    enough: float = 0.8
    body_radius: float = 0.2
    largest_error: float = pi
    sight: float = radians(148.0)
    lead: float = 0.0
    safety_radius: float = inf
    tight: float = 0.5
    cells: int = 64

    def __post_init__(self) -> None:
        """Refuse what nobody can look ahead by."""
        if len(self.pieces) > DEEPEST - 1 or min(self.pieces, default=1) < 1:
            raise ERROR(
                f"pieces must be at most {DEEPEST - 1}, of >= 1 steps [1] "
                f"each, got {self.pieces}"
            )
        steps = sum(self.pieces) + self.tail
        if self.tail < 0 or not 1 <= steps <= LONGEST:
            raise ERROR(
                f"pieces and tail must have 1 to {LONGEST} steps [1] "
                f"together, got {steps}"
            )
        check_within(self.turns, 1, 99, "turns", "1", ERROR)
        check_within(self.angle, 0.0, pi, "angle", "rad", ERROR)
        check_positive(self.enough, "enough", "m", ERROR)
        check_not_negative(self.tight, "tight", "m", ERROR)
        check_not_negative(self.body_radius, "body_radius", "m", ERROR)
        error = self.largest_error
        check_within(error, 0.01, pi, "largest_error", "rad", ERROR)
        check_within(self.sight, 0.1, pi, "sight", "rad", ERROR)
        check_within(self.lead, 0.0, 10.0, "lead", "1", ERROR)
        if not self.safety_radius > 0.0:
            raise ERROR(
                f"safety_radius must be > 0 [m], got {self.safety_radius}"
            )
        if self.cells != 0:
            check_within(self.cells, 16, 200, "cells", "1", ERROR)

    @property
    def direction(self) -> Direction:
        """Backward, eq. (3)."""
        return Direction.BACKWARD

    @property
    def saturated(self) -> bool:
        """It turns by (4)."""
        return False

    def begin(self) -> LookAheadMemory:
        """Not evading, nothing seen."""
        return LookAheadMemory()

    def decide(
        self, knowledge: Knowledge, memory: LookAheadMemory
    ) -> tuple[Intent, LookAheadMemory]:
        """Begin the maneuver that keeps the pursuer farthest."""
        from .search.turn_search import look_ahead  # takes Numba with it

        limits = knowledge.limits
        rules = rules_of(limits, self.lead)
        trace = note(memory.trace, knowledge)
        near = knowledge.distance < self.safety_radius
        if not (memory.evading or near):
            return STAND, LookAheadMemory(False, trace)
        both = place_both(trace, pursuer_heading(trace, rules))
        if knowledge.begins is not None:
            both = moved_on(both, knowledge, knowledge.begins)
        bounded = bool(knowledge.obstacles)
        known = obstacle_set(knowledge.obstacles) if bounded else NO_OBSTACLES
        packed = known.packed
        table = NO_VALUE
        if not bounded and self.cells and self.pieces:
            table = pursuit_table(self.cells, limits.speed / limits.gain)
        blur = max(knowledge.blur, GAIN)
        aims = ManeuverObjective(
            self.enough if bounded else inf,
            self.body_radius + MARGIN,
            min(PENALTY, WORTH / blur),
            self.sight,
            gain=blur,
            tight=self.tight,
        )
        plan, spot = memory.rest(knowledge.time, limits.step_duration)
        found = look_ahead(
            both,
            plan,
            self._maneuvers(limits, valued=table is not NO_VALUE),
            rules,
            aims,
            packed,
            table,
            planned=spot,
        )
        turn = float(found.turns[0])
        wanted = turn / rules.evader_share
        if found.spot:
            intent = Intent(wanted, ON_THE_SPOT)
        elif bounded and self._touches(both, turn, rules, knowledge):
            # To turn needs no room, and to stand would be to stay.
            return Intent(wanted, ON_THE_SPOT), LookAheadMemory(True, trace)
        else:
            intent = Intent(wanted)
        ahead = found.turns[: found.spot + sum(self.pieces)]
        return intent, LookAheadMemory(
            True, trace, tuple(ahead.tolist()), knowledge.time, found.spot
        )

    def _maneuvers(
        self, limits: Limits, *, valued: bool
    ) -> CandidateManeuvers:
        """Maneuvers that are tried; fewer where a table is their end."""
        share = rules_of(limits).evader_share
        return maneuvers_of(
            self.pieces[:OPEN] if valued else self.pieces,
            self.turns,
            0 if valued else self.tail,
            self.angle,
            share * self.largest_error,
            0 if valued else SPOTS,
        )

    def _touches(
        self,
        both: PlayerPair,
        turn: float,
        rules: StepRules,
        knowledge: Knowledge,
    ) -> bool:
        """Whether the step would touch something, and standing would not."""
        after = step_both(both, *half_turn(0.5 * turn), rules)
        packed = obstacle_set(knowledge.obstacles).packed
        radius = self.body_radius
        here = clearance_at(packed, both.ex, both.ey, radius)
        there = clearance_at(packed, after.ex, after.ey, radius)
        return there < radius and there < here


def rules_of(limits: Limits, lead: float = 0.0) -> StepRules:
    """Steps of both players, who are alike, from the limits of one."""
    share = limits.gain * limits.stride / limits.speed
    return StepRules(limits.stride, share, limits.stride, share, lead)


@lru_cache(maxsize=16)
def maneuvers_of(
    pieces: tuple[int, ...],
    turns: int,
    tail: int,
    angle: float,
    largest: float,
    spots: int,
) -> CandidateManeuvers:
    """Maneuvers whose turns are even, the smallest first."""
    even = np.linspace(-largest, largest, turns) if turns > 1 else np.zeros(1)
    ordered = np.array(sorted(even.tolist(), key=abs))
    steps = np.array(pieces, dtype=np.int64)
    horizon = sum(pieces) + tail
    return CandidateManeuvers(
        steps, ordered, horizon, angle, spots, ON_THE_SPOT
    )
