"""Receding-horizon search over turning sequences."""

from dataclasses import dataclass
from functools import lru_cache
from math import cos, inf, pi, radians, sin
from typing import NamedTuple

import numpy as np

from ..core.errors import (
    ConfigurationError,
    check_not_negative,
    check_positive,
    check_within,
)
from ..core.poses import Pose
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
from .search.step_motion import half_turn, step_both
from .strategy import BackwardStrategy


def poses_at_sighting(trace: Trace, heading: float) -> PlayerPair:
    """Return the poses of both players at the last sighting, in odometry.

    Args:
        trace: At least one sighting.
        heading: Heading of the pursuer in odometry, in [rad].
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


def predict_poses(
    both: PlayerPair, knowledge: Knowledge, begins: Pose
) -> PlayerPair:
    """Predict the poses of both players when the decided step begins.

    A body passes the landed foot half a step after its landing; the pursuer
    walks straight on until then.

    Args:
        both: Poses at the sighting.
        knowledge: Knowledge, for the own limits and the sighting's age.
        begins: Pose at which the step begins, in the own odometry.
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
MARGIN = 0.005  # in addition to the required clearance, in [m]
PENALTY = 60.0  # per metre of missing clearance: 1 cm costs 0.6 m
MAP_ERROR_COST = 0.5  # of missing clearance as large as the map error, [m]
SPOT_STEPS = 12  # on the spot: 12.5 of the sharpest make half a turn
MAX_STEPS = 400  # of a maneuver
GAIN = 1e-6  # of a maneuver over the present one to replace it, in [m]
TABLE_PIECES = 3  # used if a value table gives the cost-to-go


class LookAheadMemory(NamedTuple):
    """Memory of a predictive evader.

    Attributes:
        evading: Whether it evades.
        trace: Sightings of the pursuer.
        plan: Turns of the planned steps, in [rad].
        planned: Time of the first of them, in [s].
        spot: Number of initial steps that turn on the spot.
    """

    evading: bool = False
    trace: Trace = ()
    plan: tuple[float, ...] = ()
    planned: float = 0.0
    spot: int = 0

    def rest(self, time: float, step: float) -> tuple[tuple[float, ...], int]:
        """Return the rest of the plan, for a step duration in [s].

        Returns:
            Turns, and the number of initial steps that turn on the spot.
        """
        made = max(0, round((time - self.planned) / step))
        return self.plan[made:], max(0, self.spot - made)


@dataclass(frozen=True, slots=True)
class LookAhead(BackwardStrategy):
    """Predictive evader: execute the first step of the best maneuver.

    A maneuver is a sequence of pieces with a constant turn each, followed by
    the paper's law. Rolled out against a model of the pursuer, it is good if
    the pursuer stays far away and within the field of view, and no obstacle
    is touched. Without pieces and without obstacles it is the paper's law.
    An inaccurate map changes from step to step: with a map error a plan is
    kept until another is better by that error, and missing clearance costs
    less.

    Attributes:
        pieces: Number of steps of each piece.
        turns: Number of turns tried per piece, evenly spaced up to the
            largest.
        tail: Number of steps of the law after the pieces.
        angle: Strategy alpha of the law, in [rad].
        enough: Distance to the pursuer beyond which no more is gained if
            there are obstacles, in [m]; without obstacles more is better.
        body_radius: Least distance of the own centre to obstacles, in [m].
        largest_error: Largest desired heading, in [rad]; pi is the most of
            the paper's law.
        sight: Largest bearing at which the pursuer is visible, in [rad].
        lead: Assumed lead of the pursuer; see
            :class:`~stepaside.strategies.search.StepRules`.
        safety_radius: Distance at which evasion begins, in [m].
        tight: Distance to the pursuer below which maneuvers that begin with
            a turn on the spot are tried too, with obstacles, in [m].
        cells: Number of cells along each axis of the value table that gives,
            without obstacles, the cost-to-go after the last piece; 0 uses
            the law instead.
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
        """Validate the settings."""
        if len(self.pieces) > DEEPEST - 1 or min(self.pieces, default=1) < 1:
            raise ERROR(
                f"pieces must be at most {DEEPEST - 1}, of >= 1 steps [1] "
                f"each, got {self.pieces}"
            )
        steps = sum(self.pieces) + self.tail
        if self.tail < 0 or not 1 <= steps <= MAX_STEPS:
            raise ERROR(
                f"pieces and tail must have 1 to {MAX_STEPS} steps [1] "
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

    def begin(self) -> LookAheadMemory:
        """Return the memory before the first sighting."""
        return LookAheadMemory()

    def decide(
        self, knowledge: Knowledge, memory: LookAheadMemory
    ) -> tuple[Intent, LookAheadMemory]:
        """Begin the maneuver with the largest closest approach."""
        from .search.turn_search import look_ahead  # imports Numba

        limits = knowledge.limits
        rules = step_rules(limits, self.lead)
        trace = note(memory.trace, knowledge)
        near = knowledge.distance < self.safety_radius
        if not (memory.evading or near):
            return STAND, LookAheadMemory(False, trace)
        both = poses_at_sighting(trace, pursuer_heading(trace, rules))
        if knowledge.step_start_in_map is not None:
            both = predict_poses(both, knowledge, knowledge.step_start_in_map)
        bounded = bool(knowledge.obstacles_in_map)
        table = NO_VALUE
        if not bounded and self.cells and self.pieces:
            table = pursuit_table(self.cells, limits.speed / limits.gain)
        map_error = max(knowledge.map_error, GAIN)
        objective = ManeuverObjective(
            self.enough if bounded else inf,
            self.body_radius + MARGIN,
            min(PENALTY, MAP_ERROR_COST / map_error),
            self.sight,
            gain=map_error,
            tight=self.tight,
        )
        plan, spot = memory.rest(knowledge.time, limits.step_duration)
        best = look_ahead(
            both,
            plan,
            self._maneuvers(limits, valued=table is not NO_VALUE),
            rules,
            objective,
            knowledge.obstacles_in_map.packed,
            table,
            planned=spot,
        )
        turn = float(best.turns[0])
        heading = turn / rules.evader_share
        if best.spot:
            intent = Intent(heading, ON_THE_SPOT)
        elif bounded and self._touches(both, turn, rules, knowledge):
            # A turn on the spot needs no room; standing would block for good.
            return Intent(heading, ON_THE_SPOT), LookAheadMemory(True, trace)
        else:
            intent = Intent(heading)
        ahead = best.turns[: best.spot + sum(self.pieces)]
        return intent, LookAheadMemory(
            True, trace, tuple(ahead.tolist()), knowledge.time, best.spot
        )

    def _maneuvers(
        self, limits: Limits, *, valued: bool
    ) -> CandidateManeuvers:
        """Return the candidate maneuvers; fewer with a value table."""
        share = step_rules(limits).evader_share
        return maneuvers_of(
            self.pieces[:TABLE_PIECES] if valued else self.pieces,
            self.turns,
            0 if valued else self.tail,
            self.angle,
            share * self.largest_error,
            0 if valued else SPOT_STEPS,
        )

    def _touches(
        self,
        both: PlayerPair,
        turn: float,
        rules: StepRules,
        knowledge: Knowledge,
    ) -> bool:
        """Return whether a step touches an obstacle and standing does not."""
        after = step_both(both, *half_turn(0.5 * turn), rules)
        now, then = knowledge.obstacles_in_map.clearance(
            [(both.ex, both.ey), (after.ex, after.ey)]
        )
        return bool(then < min(self.body_radius, now))


def step_rules(limits: Limits, lead: float = 0.0) -> StepRules:
    """Return the step rules of two identical players with given limits."""
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
    """Return maneuvers with evenly spaced turns, the smallest first."""
    even = np.linspace(-largest, largest, turns) if turns > 1 else np.zeros(1)
    ordered = np.array(sorted(even.tolist(), key=abs))
    steps = np.array(pieces, dtype=np.int64)
    horizon = sum(pieces) + tail
    return CandidateManeuvers(
        steps, ordered, horizon, angle, spots, ON_THE_SPOT
    )
