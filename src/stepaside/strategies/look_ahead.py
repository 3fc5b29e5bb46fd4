"""Receding-horizon search over turning sequences, with a pursuer model.

A maneuver is a sequence of pieces with a constant turn each, followed by
the law of Sec. II-B until the horizon. Its score is the least distance to
the pursuer, less penalties, and never increases along a maneuver: so a
branch is pruned as soon as it is no better than the best maneuver so far. If
no sequence is good, it also tries sequences behind turns on the spot.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import atan2, cos, hypot, inf, pi, radians, sin
from typing import Any, NamedTuple

import numpy as np

from ..arena.obstacles import PackedObstacles, clearance_at
from ..core.compilation import compiled, copy_values, inlined
from ..core.poses import Array
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from ..theory.value.two_cars import pursuit_bound
from .knowledge import BODY, ON_THE_SPOT, STAND, Intent, Knowledge
from .opponent_track import OpponentTrack, track_of_steps
from .search.step_motion import (
    PAPERS,
    PlayerPair,
    StepRules,
    evader_bearing,
    evasion_heading,
    fit_heading,
    pair_in,
    pair_of,
    step_both,
    step_rules,
    store,
    update_side,
)
from .strategy import BackwardStrategy

PIECES = (2, 4, 8, 12, 16)  # steps with a constant turn
TURNS = 7  # tried per piece, evenly spaced up to the largest
HORIZON = 52  # steps of a maneuver: the pieces, and ten of the law
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

    evading: bool = False
    track: OpponentTrack | None = None  # of the pursuer
    plan: tuple[float, ...] = ()  # turns of the planned steps [rad]
    planned: float = 0.0  # time of the first of them [s]
    spot: int = 0  # number of initial steps that turn on the spot


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
    safety_radius: float = setting(
        inf,
        "Distance at which evasion begins",
        Range(0.0, 1e9, "m", "inf: always", above=True, also=(inf,)),
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
        near = knowledge.distance < self.safety_radius
        if not (memory.evading or near):
            return STAND, LookAheadMemory(False, track)
        limits = knowledge.limits
        rules = step_rules(limits)
        both = poses_at_step(track, knowledge, rules)
        if not (self.obstacles and knowledge.obstacles_in_map):
            unit = limits.speed / limits.gain
            turn = open_turn(both, rules, unit, self.cells)
            return Intent(turn / rules.share), LookAheadMemory(True, track)
        made = round((knowledge.time - memory.planned) / limits.step_duration)
        made = max(0, made)
        map_error = max(knowledge.map_error, GAIN)
        aims = Aims(
            even_turns(TURNS, rules.largest),
            self.enough,
            self.body_radius + MARGIN,
            min(PENALTY, MAP_ERROR_COST / map_error),
            map_error,
            rules,
            knowledge.obstacles_in_map.packed,
        )
        best = look_ahead(
            both,
            np.array(memory.plan[made:], dtype=np.float64),
            max(0, memory.spot - made),
            aims,
        )
        turn = float(best.turns[0])
        heading = turn / rules.share
        after = step_both(both, turn, 1.0, PAPERS, rules)
        now, then = knowledge.obstacles_in_map.clearance(
            [(both.ex, both.ey), (after.ex, after.ey)]
        )
        if not best.spot and then < min(self.body_radius, now):
            # A turn on the spot needs no room; standing would block for good.
            return Intent(heading, ON_THE_SPOT), LookAheadMemory(True, track)
        ahead = tuple(best.turns[: best.spot + sum(PIECES)].tolist())
        intent = Intent(heading, ON_THE_SPOT if best.spot else 1.0)
        return intent, LookAheadMemory(
            True, track, ahead, knowledge.time, best.spot
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


class Aims(NamedTuple):
    """Turns that a search tries, and the objective that ranks maneuvers."""

    turns: Any  # per step of a piece [rad], the preferred ones first
    enough: float  # distance to the pursuer beyond which no more is gained
    clearance: float  # that the own centre requires [m]
    penalty: float  # of missing clearance, in [m] per [m]
    gain: float  # over the present maneuver that replaces it [m]
    rules: StepRules
    packed: PackedObstacles


class BestManeuver(NamedTuple):
    """Result of the search."""

    score: float  # in [m]
    turns: Any  # of each step [rad], those of the law included
    spot: int  # number of initial steps that turn on the spot


@inlined
def judge(both: PlayerPair, score: float, aims: Aims) -> float:
    """Return the score after one more step."""
    dx, dy = both.px - both.ex, both.py - both.ey
    reward = min((dx * dx + dy * dy) ** 0.5, aims.enough)
    if reward < score:
        score = reward
    clear = clearance_at(aims.packed, both.ex, both.ey, aims.clearance)
    psi = abs(evader_bearing(both))
    if psi > SIGHT:
        score = min(score, reward - BLINDNESS * (psi - SIGHT))
    if clear < aims.clearance:
        score = min(score, reward - aims.penalty * (aims.clearance - clear))
    return score


@compiled
def roll_out(
    both: PlayerPair,
    score: float,
    turns: Any,
    given: int,
    spot: int,
    worst: float,
    aims: Aims,
) -> tuple[PlayerPair, float, int]:
    """Roll out given turns, then the law; return state, score and steps.

    It ends at a score that is no better than the worst.
    """
    rules, side = aims.rules, 0
    for n in range(len(turns)):
        if n >= given:
            psi = evader_bearing(both)
            side = update_side(side, psi, pi)
            turns[n] = rules.share * evasion_heading(psi, side, 0.5 * pi)
        pace = ON_THE_SPOT if n < spot else 1.0
        both = step_both(both, turns[n], pace, PAPERS, rules)
        score = judge(both, score, aims)
        if score <= worst:
            return both, score, n + 1
    return both, score, len(turns)


@compiled
def descend(
    both: PlayerPair,
    start: float,
    first: int,
    made: int,
    best: float,
    aims: Aims,
    chosen: Any,
    work: Any,
) -> tuple[float, int]:
    """Descend the tree of pieces; return best score and steps rolled out.

    The root has a state, a score, and a number of steps before it, whose turns
    are in ``work``; better turns than the best are written to ``chosen``.
    """
    tried, last, level = aims.turns, len(PIECES) - 1, 0
    index = np.zeros(len(PIECES), dtype=np.int64)
    begins = np.zeros(len(PIECES), dtype=np.int64)
    scores = np.zeros(len(PIECES))
    states = np.zeros((len(PIECES), 8))
    scores[0], begins[0] = start, first
    store(both, states[0])
    while level >= 0 and made < MOST:
        if index[level] == len(tried):
            level -= 1
            continue
        at, worst = begins[level], best + aims.gain
        piece = work[at : at + PIECES[level]]
        for n in range(len(piece)):
            piece[n] = tried[index[level]]
        index[level] += 1
        here, score = pair_in(states[level]), scores[level]
        here, score, more = roll_out(
            here, score, piece, len(piece), 0, worst, aims
        )
        made += more
        if score <= worst:
            continue
        at += len(piece)
        if level < last:
            level += 1
            index[level], begins[level], scores[level] = 0, at, score
            store(here, states[level])
            continue
        rest = work[at : first + HORIZON]
        here, score, more = roll_out(here, score, rest, 0, 0, worst, aims)
        made += more
        if score > worst:
            best = score
            copy_values(work, chosen)
            if best >= start:
                break
    return best, made


@compiled
def look_ahead(
    both: PlayerPair, plan: Any, planned: int, aims: Aims
) -> BestManeuver:
    """Find the best maneuver among obstacles.

    The law alone is tried first, then the rest of the plan, and then every
    sequence of pieces; a tie keeps the plan.
    """
    chosen, work = np.zeros(HORIZON + SPOTS), np.zeros(HORIZON + SPOTS)
    start, best, spot, made = aims.enough, -inf, 0, 0
    for given in (0, min(len(plan), HORIZON)):
        copy_values(plan[:given], work)
        worst, begins = best - aims.gain, min(planned, given)
        _, score, more = roll_out(
            both, start, work[:HORIZON], given, begins, worst, aims
        )
        made += more
        if score > worst:
            best, spot = score, begins
            copy_values(work, chosen)
    if best >= start:
        return BestManeuver(best, chosen[: HORIZON + spot], spot)
    found, made = descend(both, start, ROOT, made, best, aims, chosen, work)
    if found > best:
        best, spot = found, 0
    if best < TIGHT:
        for side in (-1.0, 1.0):
            here, score = both, start
            for n in range(SPOTS):
                work[n] = side * aims.rules.largest
                worst, turn = best + aims.gain, work[n : n + 1]
                here, score, more = roll_out(
                    here, score, turn, 1, 1, worst, aims
                )
                made += more
                if score <= worst:
                    break
                if n % 2 == 0:
                    continue
                found, made = descend(
                    here, score, n + 1, made, best, aims, chosen, work
                )
                if found > best:
                    best, spot = found, n + 1
    return BestManeuver(best, chosen[: HORIZON + spot], spot)
