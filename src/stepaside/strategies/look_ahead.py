"""Receding-horizon search over turning sequences."""

from dataclasses import dataclass, replace
from functools import lru_cache
from math import atan2, hypot, inf, pi, radians
from typing import NamedTuple

import numpy as np

from ..arena import NO_OBSTACLES
from ..core.errors import ConfigurationError, shown
from ..core.poses import Array, Pose
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from .knowledge import ON_THE_SPOT, STAND, Intent, Knowledge, Limits
from .opponent_track import OpponentTrack, track_of_steps
from .search.step_motion import (
    PlayerPair,
    PursuerModel,
    StepRules,
    fit_heading,
    pair_of,
    step_both,
)
from .search.turn_search import (
    DEEPEST,
    NO_VALUE,
    PursuitValues,
    TurnSearch,
    look_ahead,
)
from .strategy import BackwardStrategy
from .table_cache import pursuit_bound

MARGIN = 0.005  # in addition to the required clearance, in [m]
PENALTY = 60.0  # per metre of missing clearance: 1 cm costs 0.6 m
MAP_ERROR_COST = 0.5  # of missing clearance as large as the map error, [m]
SIGHT = radians(148.0)  # largest bearing at which the pursuer is visible
TIGHT = 0.5  # distance to the pursuer below which maneuvers that begin with a
# turn on the spot are tried too, with obstacles, in [m]
SPOT_STEPS = 12  # on the spot: 12.5 of the sharpest make half a turn
MAX_STEPS = 400  # of a maneuver
STEPS = Range(1, MAX_STEPS, "1", "decisions take longer", whole=True)
SIGHTINGS = 3  # a step apart: over two steps the sway cancels
MIN_MOTION = 0.3  # per step, in strides, that determines a heading
GAIN = 1e-6  # of a maneuver over the present one to replace it, in [m]
TABLE_PIECES = 3  # used if a value table gives the cost-to-go
PAPERS = PursuerModel()


class LookAheadMemory(NamedTuple):
    """Memory of a predictive evader.

    Attributes:
        evading: Whether it evades.
        track: Sightings of the pursuer.
        plan: Turns of the planned steps, in [rad].
        planned: Time of the first of them, in [s].
        spot: Number of initial steps that turn on the spot.
    """

    evading: bool = False
    track: OpponentTrack | None = None
    plan: tuple[float, ...] = ()
    planned: float = 0.0
    spot: int = 0


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
    """

    pieces: tuple[int, ...] = (2, 4, 8, 12, 16)
    turns: int = setting(
        7,
        "Turns tried per piece, evenly spaced up to the largest",
        Range(1, 99, "1", "decisions take longer", whole=True),
    )
    tail: int = setting(
        10,
        "Steps of the law after the pieces",
        Range(0, MAX_STEPS, "1", "decisions take longer", whole=True),
    )
    angle: float = setting(
        pi / 2,
        "Strategy alpha of the law",
        Range(0.0, pi, "rad", "the sign is given by the side"),
    )
    enough: float = setting(
        0.8,
        "Distance to the pursuer beyond which no more is gained if there are "
        "obstacles {unit}; without obstacles more is better",
        Range(0.0, 1e9, "m", "it keeps a distance", above=True, also=(inf,)),
    )
    body_radius: float = setting(
        0.2,
        "Least distance of the own centre to obstacles",
        Range(0.0, 10.0, "m", "the size of a body"),
    )
    safety_radius: float = setting(
        inf,
        "Distance at which evasion begins",
        Range(0.0, 1e9, "m", "inf: always", above=True, also=(inf,)),
    )
    cells: int = setting(
        64,
        "Cells along each axis of the value table that gives, without "
        "obstacles, the cost-to-go after the last piece; 0 uses the law",
        Range(16, 200, "1", "accuracy, and time to solve", False, True, (0,)),
    )
    obstacles: bool = setting(True, "Avoid obstacles")

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)
        pieces = self.pieces
        if not isinstance(pieces, tuple) or len(pieces) > DEEPEST - 1:
            raise ConfigurationError(
                f"pieces must be a tuple of at most {DEEPEST - 1} numbers of "
                f"steps [1], got {shown(pieces)}"
            )
        for each in (*pieces, sum(pieces) + self.tail):
            STEPS.check(each, "each of pieces, and pieces and tail together,")

    def begin(self) -> LookAheadMemory:
        """Return the memory before the first sighting."""
        return LookAheadMemory()

    def decide(
        self, knowledge: Knowledge, memory: LookAheadMemory
    ) -> tuple[Intent, LookAheadMemory]:
        """Begin the maneuver with the largest closest approach."""
        if not self.obstacles:
            knowledge = replace(knowledge, obstacles_in_map=NO_OBSTACLES)
        track = track_of_steps(memory.track, knowledge)
        near = knowledge.distance < self.safety_radius
        if not (memory.evading or near):
            return STAND, LookAheadMemory(False, track)
        limits = knowledge.limits
        rules = step_rules(limits)
        both = poses_at_sighting(track, rules)
        if knowledge.step_start_in_map is not None:
            both = predict_poses(both, knowledge, knowledge.step_start_in_map)
        bounded = bool(knowledge.obstacles_in_map)
        valued = not bounded and bool(self.cells and self.pieces)
        made = round((knowledge.time - memory.planned) / limits.step_duration)
        best = look_ahead(
            both,
            np.array(memory.plan[max(0, made) :], dtype=np.float64),
            max(0, memory.spot - max(0, made)),
            self._search(knowledge, rules.largest, valued=valued),
            PAPERS,
            rules,
            knowledge.obstacles_in_map.packed,
            pursuit_table(self.cells, limits.speed / limits.gain)
            if valued
            else NO_VALUE,
        )
        turn = float(best.turns[0])
        heading = turn / rules.share
        if best.spot:
            intent = Intent(heading, ON_THE_SPOT)
        elif bounded and self._touches(both, turn, rules, knowledge):
            # A turn on the spot needs no room; standing would block for good.
            return Intent(heading, ON_THE_SPOT), LookAheadMemory(True, track)
        else:
            intent = Intent(heading)
        ahead = best.turns[: best.spot + sum(self.pieces)]
        return intent, LookAheadMemory(
            True, track, tuple(ahead.tolist()), knowledge.time, best.spot
        )

    def _search(
        self, knowledge: Knowledge, largest: float, *, valued: bool
    ) -> TurnSearch:
        """Return the maneuvers and what ranks them; fewer with a value."""
        pieces = self.pieces[:TABLE_PIECES] if valued else self.pieces
        tail = 0 if valued else self.tail
        map_error = max(knowledge.map_error, GAIN)
        return TurnSearch(
            np.array(pieces, dtype=np.int64),
            even_turns(self.turns, largest),
            sum(pieces) + tail,
            self.angle,
            0 if valued else SPOT_STEPS,
            self.enough if knowledge.obstacles_in_map else inf,
            self.body_radius + MARGIN,
            min(PENALTY, MAP_ERROR_COST / map_error),
            SIGHT,
            map_error,
            TIGHT,
        )

    def _touches(
        self,
        both: PlayerPair,
        turn: float,
        rules: StepRules,
        knowledge: Knowledge,
    ) -> bool:
        """Return whether a step touches an obstacle and standing does not."""
        after = step_both(both, turn, 1.0, PAPERS, rules)
        now, then = knowledge.obstacles_in_map.clearance(
            [(both.ex, both.ey), (after.ex, after.ey)]
        )
        return bool(then < min(self.body_radius, now))


def poses_at_sighting(track: OpponentTrack, rules: StepRules) -> PlayerPair:
    """Return the poses of both players at the last sighting, in the map.

    The heading of the pursuer is that of the paper's along the last
    sightings. One that has not moved is assumed to face the own robot.
    """
    rows = track.rows[-SIGHTINGS:]
    first, last = rows[0], rows[-1]
    own = last.own
    heading = atan2(own.y - last.y, own.x - last.x)
    way = hypot(last.x - first.x, last.y - first.y)
    least = MIN_MOTION * (len(rows) - 1) * rules.stride
    if len(rows) > 1 and way >= least:
        path = [(*row.own, row.x, row.y, n) for n, row in enumerate(rows)]
        (_, _, heading), _ = fit_heading(np.array(path), PAPERS, rules)
    return pair_of(own, (last.x, last.y, heading))


def predict_poses(
    both: PlayerPair, knowledge: Knowledge, begins: Pose
) -> PlayerPair:
    """Predict the poses of both players when the decided step begins.

    A body passes the landed foot half a step after its landing; the pursuer
    walks straight on until then.
    """
    limits = knowledge.limits
    way = limits.stride * (0.5 + knowledge.age / limits.step_duration)
    x, y = both.px + way * both.pc, both.py + way * both.ps
    return PlayerPair(*pair_of(begins, (x, y, 0.0))[:6], both.pc, both.ps)


def step_rules(limits: Limits) -> StepRules:
    """Return the rules of a step of given limits."""
    return StepRules(limits.stride, limits.share, pi * limits.share)


@lru_cache(maxsize=16)
def even_turns(count: int, largest: float) -> Array:
    """Return evenly spaced turns, in [rad], the smallest first."""
    even = np.linspace(-largest, largest, count) if count > 1 else np.zeros(1)
    return np.array(sorted(even.tolist(), key=abs))


@lru_cache(maxsize=8)
def pursuit_table(cells: int, unit: float) -> PursuitValues:
    """Return the table of :func:`pursuit_bound` for compiled loops.

    The unit of length is speed over gain, in [m].
    """
    bound = pursuit_bound(cells)
    values = bound.values.astype(np.float32)
    return PursuitValues(values, bound.grid.left, bound.grid.spacing, unit)
