"""Receding-horizon search over turning sequences, with a pursuer model.

A maneuver is a sequence of pieces with a constant turn each, followed by
the law of Sec. II-B until the horizon. Its score is the least distance to
the pursuer, less penalties, and never increases along a maneuver: so a
branch is pruned as soon as it is no better than the best maneuver so far. If
no sequence is good, it also tries sequences behind turns on the spot.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import atan2, cos, hypot, inf, radians, sin
from typing import Any, NamedTuple

import numpy as np

from ..core.compilation import compiled, inlined
from ..core.poses import Array
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from ..theory.value.two_cars import pursuit_bound
from .knowledge import BODY, ON_THE_SPOT, Intent, Knowledge
from .opponent_track import OpponentTrack, track_of_steps
from .search.step_motion import (
    PAPERS,
    Objective,
    PlayerPair,
    StepRules,
    fit_heading,
    pair_in,
    pair_of,
    roll_out,
    step_both,
    step_rules,
    store,
)
from .strategy import BackwardStrategy

PIECES = (2, 4, 8, 12, 16)  # steps with a constant turn
TURNS = 7  # tried per piece, evenly spaced up to the largest
LAW = 10  # steps of the law behind the pieces
HORIZON = sum(PIECES) + LAW  # steps of a maneuver
SPOTS = 12  # steps on the spot before the first piece; 12.5 of the sharpest
# make half a turn
MOST = 40_000  # rolled-out steps after which no further maneuver is begun
TIGHT = 0.5  # score below which turns on the spot are tried, in [m]
BLINDNESS = 0.1  # cost of a bearing beyond sight, in [m] per [rad]
SIGHT = radians(148.0)  # largest bearing at which the pursuer is visible
MARGIN = 0.005  # in addition to the required clearance, in [m]
PENALTY = 60.0  # per metre of missing clearance: 1 cm costs 0.6 m
MAP_ERROR_COST = 0.5  # of missing clearance as large as the map error, [m]
GAIN = 1e-6  # of a maneuver over the present one to replace it, in [m]
SIGHTINGS = 3  # a step apart: over two steps the sway cancels
MIN_MOTION = 0.3  # per step, in strides, that determines a heading
OPEN_TURNS = 15  # tried by that table
ROOT: Any = np.int64(0)  # a literal would compile a version of its own


class LookAheadMemory(NamedTuple):
    """Memory of a predictive evader."""

    track: OpponentTrack | None = None  # of the pursuer
    moves: Array = np.empty((0, 2))  # turn [rad], speed factor of its plan
    planned: float = 0.0  # time of the first of them [s]


@dataclass(frozen=True, slots=True)
class LookAhead(BackwardStrategy, CheckedSettings):
    """Predictive evader: execute the first step of the best maneuver.

    Rolled out against the paper's pursuer, a maneuver is good if the pursuer
    stays far away and within the field of view, and no obstacle is touched.
    An inaccurate map changes from step to step: with a map error a plan is
    kept until another is better by that error, and missing clearance costs
    less. Without obstacles it takes the step after which the value table of
    the open floor promises the largest distance.
    """

    enough: float = setting(
        0.8,
        "Distance to the pursuer beyond which no more is gained if there are "
        "obstacles {unit}; without obstacles more is better",
        Range(0.0, 1e9, "m", "it keeps a distance", above=True, also=(inf,)),
    )
    body_radius: float = setting(
        0.2, "Least distance of the own centre to obstacles", BODY
    )
    cells: int = setting(
        64,
        "Cells along each axis of the value table of an open floor",
        Range(16, 200, "1", "accuracy, and time to solve", whole=True),
    )
    obstacles: bool = setting(True, "Avoid obstacles")

    def begin(self) -> LookAheadMemory:
        """Return the memory before the first sighting."""
        return LookAheadMemory()

    def decide(
        self, knowledge: Knowledge, memory: LookAheadMemory
    ) -> tuple[Intent, LookAheadMemory]:
        """Begin the maneuver with the largest closest approach."""
        track = track_of_steps(memory.track, knowledge)
        limits = knowledge.limits
        rules = step_rules(limits)
        both = poses_at_step(track, knowledge, rules)
        if not (self.obstacles and knowledge.obstacles_in_map):
            unit = limits.speed / limits.gain
            turn = open_turn(both, rules, unit, self.cells)
            return Intent(turn / rules.share), LookAheadMemory(track)
        made = round((knowledge.time - memory.planned) / limits.step_duration)
        made = max(0, made)
        map_error = max(knowledge.map_error, GAIN)
        moves = look_ahead(
            both,
            memory.moves[made:],
            even_turns(TURNS, rules.largest),
            map_error,
            Objective(
                rules,
                knowledge.obstacles_in_map.packed,
                self.body_radius + MARGIN,
                self.enough,
                penalty=min(PENALTY, MAP_ERROR_COST / map_error),
                blindness=BLINDNESS,
                sight=cos(SIGHT),
            ),
        )
        turn, pace = moves[0].tolist()
        after = step_both(both, turn, 1.0, PAPERS, rules)
        now, then = knowledge.obstacles_in_map.clearance(
            [(both.ex, both.ey), (after.ex, after.ey)]
        )
        if pace == 1.0 and then < min(self.body_radius, now):
            # A turn on the spot needs no room; standing would block for good.
            moves, pace = memory.moves[:0], ON_THE_SPOT
        return Intent(turn / rules.share, pace), LookAheadMemory(
            track, moves[:-LAW], knowledge.time
        )


def poses_at_step(
    track: OpponentTrack, knowledge: Knowledge, rules: StepRules
) -> PlayerPair:
    """Return the poses of both players when the decided step begins.

    The pursuer turned as the paper's, or faces the own robot if it has not
    moved. A body passes a landed foot half a step later; the pursuer walks
    straight on until then.
    """
    rows = track.rows[-SIGHTINGS:]
    first, last = rows[0], rows[-1]
    begins, x, y = last.own, last.x, last.y
    heading = atan2(begins.y - y, begins.x - x)
    way = hypot(x - first.x, y - first.y)
    least = MIN_MOTION * (len(rows) - 1) * rules.stride
    if len(rows) > 1 and way >= least:
        path = [(*row.own, row.x, row.y, n) for n, row in enumerate(rows)]
        (_, _, heading), _ = fit_heading(np.array(path), PAPERS, rules)
    if knowledge.step_start_in_map is not None:
        begins = knowledge.step_start_in_map
        waits = knowledge.age / knowledge.limits.step_duration
        way = rules.stride * (0.5 + waits)
        x, y = x + way * cos(heading), y + way * sin(heading)
    return pair_of(begins, (x, y, heading))


@lru_cache(maxsize=16)
def even_turns(count: int, largest: float) -> Array:
    """Return evenly spaced turns, in [rad], the smallest first."""
    even = np.linspace(-largest, largest, count).tolist()
    return np.array(sorted(even, key=abs))


def open_turn(
    both: PlayerPair, rules: StepRules, unit: float, cells: int
) -> float:
    """Return the turn [rad] to the best state on an open floor.

    The unit of length of its value table is speed over gain, in [m].
    """
    turns = even_turns(OPEN_TURNS, rules.largest)
    ends = [step_both(both, u, 1.0, PAPERS, rules) for u in turns.tolist()]
    ex, ey, ec, es, px, py, pc, ps = np.array(ends).T
    dx, dy = (ex - px) / unit, (ey - py) / unit
    # The evader walks backwards: it moves against its heading.
    away = np.arctan2(ec * ps - es * pc, -ec * pc - es * ps)
    poses = np.stack([pc * dx + ps * dy, pc * dy - ps * dx, away], axis=-1)
    return float(turns[pursuit_bound(cells).value(poses).argmax()])


@inlined
def copy_moves(source: Any, target: Any) -> None:
    """Copy the moves of a maneuver, (n, 2)."""
    for n in range(len(source)):
        target[n, 0], target[n, 1] = source[n, 0], source[n, 1]


class ManeuverSearch(NamedTuple):
    """Maneuvers that are tried, and the best so far."""

    turns: Any  # per step of a piece [rad], the preferred ones first
    gain: float  # over the present maneuver that replaces it [m]
    objective: Objective
    chosen: Any  # moves of the best maneuver. (n, 2)
    work: Any  # moves of the one that is tried. (n, 2)


@compiled
def descend(
    both: PlayerPair,
    start: float,
    first: int,
    made: int,
    best: float,
    search: ManeuverSearch,
) -> tuple[float, int]:
    """Descend the tree of pieces; return best score and steps rolled out.

    The root has a state, a score, and a number of moves before it, which are
    those of the search; better moves than the best are stored there.
    """
    turns, objective, work = search.turns, search.objective, search.work
    last, level = len(PIECES) - 1, 0
    index = np.zeros(len(PIECES), dtype=np.int64)
    begins = np.zeros(len(PIECES), dtype=np.int64)
    scores = np.zeros(len(PIECES))
    states = np.zeros((len(PIECES), 8))
    scores[0], begins[0] = start, first
    store(both, states[0])
    while level >= 0 and made < MOST:
        if index[level] == len(turns):
            level -= 1
            continue
        at, worst = begins[level], best + search.gain
        moves = work[at : at + PIECES[level]]
        for n in range(len(moves)):
            moves[n, 0], moves[n, 1] = turns[index[level]], 1.0
        index[level] += 1
        here, score, walked = roll_out(
            pair_in(states[level]),
            scores[level],
            moves,
            len(moves),
            worst,
            PAPERS,
            objective,
        )
        made += min(walked + 1, len(moves))
        if walked < len(moves):
            continue
        at += walked
        if level < last:
            level += 1
            index[level], begins[level], scores[level] = 0, at, score
            store(here, states[level])
            continue
        moves = work[at : first + HORIZON]
        _, score, walked = roll_out(
            here, score, moves, 0, worst, PAPERS, objective
        )
        made += min(walked + 1, len(moves))
        if walked == len(moves):
            best = score
            copy_moves(work, search.chosen)
            if best >= start:
                break
    return best, made


@compiled
def look_ahead(
    both: PlayerPair, plan: Any, turns: Any, gain: float, objective: Objective
) -> Any:
    """Return the moves of the best maneuver among obstacles, (n, 2).

    The law alone is tried first, then the rest of the plan, and then every
    sequence of pieces of some turns [rad], the preferred ones first. A plan
    gives way to what is better by a gain [m].
    """
    chosen, work = np.zeros((HORIZON + SPOTS, 2)), np.zeros((HORIZON, 2))
    chosen[:, 1] = 1.0
    start, best, spot, made = objective.enough, -inf, 0, 0
    for given in (0, min(len(plan), HORIZON)):
        copy_moves(plan[:given], work)
        _, score, walked = roll_out(
            both, start, work, given, best - gain, PAPERS, objective
        )
        made += min(walked + 1, HORIZON)
        if walked == HORIZON:
            best = score
            copy_moves(work, chosen)
    while chosen[spot, 1] < 1.0:
        spot += 1
    if best >= start:
        return chosen[: HORIZON + spot]
    work = np.zeros_like(chosen)
    search = ManeuverSearch(turns, gain, objective, chosen, work)
    found, made = descend(both, start, ROOT, made, best, search)
    if found > best:
        best, spot = found, 0
    if best < TIGHT:
        for side in (-1.0, 1.0):
            here, score = both, start
            for n in range(SPOTS):
                move = work[n : n + 1]
                move[0, 0] = side * objective.rules.largest
                move[0, 1] = ON_THE_SPOT
                here, score, walked = roll_out(
                    here, score, move, 1, best + gain, PAPERS, objective
                )
                made += 1
                if walked == 0:
                    break
                if n % 2 == 0:
                    continue
                found, made = descend(here, score, n + 1, made, best, search)
                if found > best:
                    best, spot = found, n + 1
    return chosen[: HORIZON + spot]
