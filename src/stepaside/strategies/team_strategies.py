"""Strategies among several: of teams, and the walk to a goal."""

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import product
from math import atan2, cos, dist, hypot, inf, pi, sin
from typing import Any

import numpy as np

from ..core.compilation import compiled
from ..core.poses import Array, Pose, wrap_angle
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..theory import laws
from .evasion import RELEASE, SAFETY, check_release
from .knowledge import STAND, Intent, Knowledge
from .pursuit import Pursuit, PursuitMemory
from .search.step_motion import (
    PAPERS,
    StepRules,
    pair_of,
    step_both,
    step_rules,
)
from .strategy import BackwardStrategy
from .velocity_set import BodyVelocity, VelocitySet, greatest_velocity

APART = 0.7  # from teammates from which pursuers turn away, in [m]
TOO_NEAR = 0.45  # to a teammate ahead at which a pursuer halts, in [m]
BESIDE = -0.6  # cosine of the bearing from which a teammate is behind
SPREAD = pi / 2  # from the middle of a pincer to its outermost pursuers, [rad]
NEAR = 0.7  # from which they head straight for the evader, in [m]
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class CyclicPursuit(Pursuit):
    """Pursuer of the next player of its own team, in the order of names.

    All players of a team end on a regular polygon.
    """

    def decide(
        self, knowledge: Knowledge, memory: PursuitMemory
    ) -> tuple[Intent, PursuitMemory]:
        """Head for the next player by eq. (2)."""
        own = knowledge.identity
        if own is not None:
            team = {o.identity.name: o for o in knowledge.teammates}
            if not team:
                return STAND, memory
            names = sorted([own.name, *team])
            following = names[(names.index(own.name) + 1) % len(names)]
            knowledge = knowledge.about(team[following])
        return Pursuit.decide(self, knowledge, memory)


@dataclass(frozen=True, slots=True)
class AssignedPursuit(Pursuit):
    """Pursuer of the evader that its team assigns to it.

    Each computes the assignment with the least total distance.
    """

    def decide(
        self, knowledge: Knowledge, memory: PursuitMemory
    ) -> tuple[Intent, PursuitMemory]:
        """Head for the assigned evader by eq. (2)."""
        evaders = sorted(
            knowledge.opponents, key=lambda other: other.identity.name
        )
        if evaders:
            hunters, own = fellows_of(knowledge), knowledge.identity
            assert own is not None
            places = [other.position for other in evaders]
            ways = [[dist(p, q) for q in places] for p in hunters.values()]
            row = list(hunters).index(own.name)
            knowledge = knowledge.about(evaders[assign(np.array(ways))[row]])
        intent, memory = Pursuit.decide(self, knowledge, memory)
        return keep_apart(knowledge, intent), memory


@dataclass(frozen=True, slots=True)
class Pincer(Pursuit):
    """Pursuer that approaches from one side while teammates take others."""

    def decide(
        self, knowledge: Knowledge, memory: PursuitMemory
    ) -> tuple[Intent, PursuitMemory]:
        """Head for a point beside the evader, or for the evader itself."""
        hunters = fellows_of(knowledge)
        if len(hunters) > 1 and knowledge.distance > NEAR:
            u, v = knowledge.position
            x, y = np.mean(list(hunters.values()), axis=0).tolist()
            middle = atan2(y - v, x - u)
            sides = {
                name: wrap_angle(atan2(q - v, p - u) - middle)
                for name, (p, q) in hunters.items()
            }
            own = knowledge.identity.name if knowledge.identity else ""
            ordered = sorted(sides, key=lambda name: (sides[name], name))
            share = 2.0 * ordered.index(own) / (len(ordered) - 1) - 1.0
            angle = middle + SPREAD * share
            out = 0.6 * knowledge.distance
            knowledge = knowledge.towards(
                u + out * cos(angle), v + out * sin(angle)
            )
        intent, memory = Pursuit.decide(self, knowledge, memory)
        return keep_apart(knowledge, intent), memory


def assign(costs: Array) -> tuple[int, ...]:
    """Return the column of each row of the assignment of least total cost.

    With more rows than columns every column is used, and none more than once
    more often than another.
    """
    from scipy.optimize import linear_sum_assignment

    rows, columns = costs.shape
    least = rows // columns  # uses of each column; some have one more
    slots = (least + 1) * columns
    square = np.zeros((slots, slots))  # rows below leave their slot unused
    square[:rows] = np.tile(costs, least + 1)
    square[rows:, : least * columns] = 1.0 + slots * np.abs(costs).max()
    _, taken = linear_sum_assignment(square)
    return tuple((taken[:rows] % columns).tolist())


def fellows_of(knowledge: Knowledge) -> dict[str, Point]:
    """Return positions of the own team's pursuers by name, in the frame."""
    own = knowledge.identity
    if own is None:
        return {"": (0.0, 0.0)}
    found: dict[str, Point] = {own.name: (0.0, 0.0)}
    for other in knowledge.teammates:
        if other.identity.role is own.role:
            found[other.identity.name] = other.position
    return dict(sorted(found.items()))


def keep_apart(knowledge: Knowledge, intent: Intent) -> Intent:
    """Return an intent that turns away from near teammates, or halts."""
    heading = intent.heading
    for mate in knowledge.teammates:
        ahead = cos(mate.bearing)
        if mate.distance >= APART or ahead < BESIDE:
            continue
        if mate.distance < TOO_NEAR and ahead > 0.5:
            return STAND
        side = 1.0 if mate.bearing > 0.0 else -1.0
        closeness = 1.0 - mate.distance / APART
        heading -= side * pi * min(3.0 * closeness, 1.0)
    return replace(intent, heading=min(max(heading, -pi), pi))


PIECES = (4, 8, 16)  # steps with a constant turn
TURNS = 7  # values of the turn of each piece
FINAL = 0.2  # weight of the distance at the end beside the closest one
SMALL = 1e-6  # weight of a turn, against ties


@dataclass(frozen=True, slots=True)
class TeamEvasion(BackwardStrategy):
    """Evader that reasons about all pursuers at once.

    It walks backward, and begins the turning sequence after which the
    smallest distance to any pursuer is largest, if each moves by (1)-(2) with
    the own gait. This is no guarantee: they may move otherwise.
    """

    safety_radius: float = setting(
        0.8, "Distance of the nearest pursuer at which evasion begins", SAFETY
    )
    release_distance: float = setting(
        inf, "Distance of the nearest pursuer at which evasion ends", RELEASE
    )

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)
        check_release(self.safety_radius, self.release_distance)

    def begin(self) -> bool:
        """Return that it does not evade yet."""
        return False

    def decide(
        self, knowledge: Knowledge, memory: bool
    ) -> tuple[Intent, bool]:
        """Stand until the trigger, then begin the best sequence."""
        nearest = min(
            (other.distance for other in knowledge.opponents),
            default=knowledge.distance,
        )
        evading = laws.is_evading(
            memory, nearest, self.safety_radius, self.release_distance
        )
        if not evading:
            return STAND, False
        rules = step_rules(knowledge.limits)
        turns = candidate_turns(rules.largest)
        least, last = np.full((2, len(turns)), inf)
        roll_out_all(pursuers_of(knowledge), turns, rules, least, last)
        score = least + FINAL * last - SMALL * np.abs(turns[:, 0])
        best = turns[int(score.argmax()), 0]
        return Intent(float(best) / rules.share), True


def pursuers_of(knowledge: Knowledge) -> Array:
    """Return the poses of all opponents; one who stands faces the evader."""
    rows = []
    for other in knowledge.opponents or (knowledge,):
        (x, y), (u, v) = other.position, other.velocity or (0.0, 0.0)
        faces = hypot(u, v) <= 0.01
        rows.append((x, y, atan2(-y, -x) if faces else atan2(v, u)))
    return np.array(rows)


@lru_cache(maxsize=8)
def candidate_turns(largest: float) -> Array:
    """Return turns [rad] of each step of all candidates."""
    even = np.linspace(-largest, largest, TURNS)
    pieces = list(product(even, repeat=len(PIECES)))
    return np.repeat(pieces, PIECES, axis=1)


@compiled
def roll_out_all(
    pursuers: Any, turns: Any, rules: StepRules, least: Any, last: Any
) -> None:
    """Write the least distance to any pursuer, in all and at the end, in [m].

    The evader walks from the origin of the frame by turns of each candidate.
    """
    for j in range(len(turns)):
        for i in range(len(pursuers)):
            both = pair_of((0.0, 0.0, 0.0), pursuers[i])
            away = hypot(both.px, both.py)
            least[j] = min(least[j], away)
            for turn in turns[j]:
                both = step_both(both, turn, 1.0, PAPERS, rules)
                away = hypot(both.ex - both.px, both.ey - both.py)
                least[j] = min(least[j], away)
            last[j] = min(last[j], away)


ARRIVED = 0.2  # distance from the goal at which it halts, in [m]
HORIZON = 4.0  # of the prediction, in [s]
DEVIATIONS = np.linspace(-pi / 2, pi / 2, 19)  # tried headings, in [rad]
WEIGHT = 4.0  # of a missing metre of clearance, in [rad]
DIRECTIONS = 24  # of the velocities tried, in any direction
SHARES = (0.0, 0.5, 1.0)  # of the fastest velocity in a direction
REACTION = 0.5  # in which legs follow a new velocity, in [s]
WALL_WEIGHT = 20.0  # of a missing metre of clearance from walls, in [rad]
LOOKS = 5  # points along a heading at which walls are looked up
SOON = 2.5  # time to a predicted contact at which it halts, in [s]
FREE = Range(0.0, 10.0, "m", "beyond, no way is free")


@dataclass(frozen=True, slots=True)
class GoalWalk(Pursuit):
    """Walk to a goal, giving way to others.

    It takes the heading that deviates least from the way to the goal and
    keeps clear of every other player, at constant velocities, and halts while
    none does. Legs that walk in any direction choose among velocities
    likewise, by the progress that each loses.
    """

    goal: tuple[float, ...] = setting(
        (), "Goal (x, y) in the frame of the map [m]; none stands"
    )
    clearance: float = setting(0.8, "Distance that it keeps from others", FREE)
    contact: float = setting(0.45, "Distance that counts as contact", FREE)

    def decide(
        self, knowledge: Knowledge, memory: PursuitMemory
    ) -> tuple[Intent, PursuitMemory]:
        """Head for the goal, beside others, and halt there."""
        if not self.goal:
            return STAND, memory
        x, y = self.goal
        there = knowledge.pose_in_map.inverse().compose(Pose(x, y, 0.0))
        if hypot(there.x, there.y) < ARRIVED:
            return STAND, memory
        aimed = knowledge.towards(there.x, there.y)
        intent, memory = Pursuit.decide(self, aimed, memory)
        velocities, bearing = knowledge.limits.velocities, aimed.bearing
        if velocities is not None:
            if knowledge.obstacles_in_map:
                bearing = self.course(aimed)[0]
            return self._clear_velocity(knowledge, bearing, velocities), memory
        if knowledge.others:
            intent = self._clear_heading(knowledge, intent.heading)
        return intent, memory

    def _clear_heading(self, knowledge: Knowledge, wanted: float) -> Intent:
        """Return the heading that keeps clear; stand if none does."""
        limits = knowledge.limits
        speed = limits.stride / limits.step_duration
        directions = wanted + DEVIATIONS
        own = speed * np.stack([np.cos(directions), np.sin(directions)])
        least, when = nearest_passages(knowledge, own)
        missing = np.maximum(self.clearance - least, 0.0).sum(axis=0)
        costs = np.abs(DEVIATIONS) + WEIGHT * missing
        best = int((costs + self._wall_cost(knowledge, own)).argmin())
        contacts = when[:, best][least[:, best] < self.contact]
        if contacts.size and contacts.min() < SOON:
            return STAND
        return Intent(wrap_angle(float(directions[best])))

    def _clear_velocity(
        self, knowledge: Knowledge, bearing: float, velocities: VelocitySet
    ) -> Intent:
        """Return the velocity in any direction that keeps clear."""
        angles = bearing + np.linspace(-pi, pi, DIRECTIONS, endpoint=False)
        fastest = np.array(
            [greatest_velocity(each, velocities) for each in angles]
        ).T
        own = np.concatenate([s * fastest for s in SHARES], axis=1)
        progress = cos(bearing) * own[0] + sin(bearing) * own[1]
        least, when = nearest_passages(knowledge, own, earliest=REACTION)
        missing = np.maximum(self.clearance - least, 0.0)
        missing += np.maximum(self.contact - least, 0.0) / when
        costs = (progress.max() - progress) / max(progress.max(), 1e-9)
        costs = costs + WEIGHT * missing.sum(axis=0)
        best = int((costs + self._wall_cost(knowledge, own)).argmin())
        turn = knowledge.limits.gain * wrap_angle(bearing)
        wanted = BodyVelocity(float(own[0, best]), float(own[1, best]), turn)
        return Intent(velocity=velocities.nearest(wanted))

    def _wall_cost(self, knowledge: Knowledge, own: Array) -> Array:
        """Return the cost of own velocities, (2, n), towards obstacles."""
        solids, radius = knowledge.obstacles_in_map, self.body_radius
        if not solids:
            return np.zeros(own.shape[1])
        times = np.arange(1, LOOKS + 1) * (SOON / LOOKS)
        ahead = np.moveaxis(own[:, :, None] * times, 0, -1).reshape(-1, 2)
        points = knowledge.pose_in_map.transform_points(ahead)
        gaps = solids.clearance(points).reshape(-1, LOOKS).min(axis=1)
        cost: Array = WALL_WEIGHT * np.maximum(radius - gaps, 0.0)
        return cost


def nearest_passages(
    knowledge: Knowledge, own: Array, *, earliest: float = 0.0
) -> tuple[Array, Array]:
    """Predict the closest approach of each other player, at constant velocity.

    Own velocities (2, n) are those in the frame, in [m/s]; no choice changes
    approaches before the earliest time. Returns distances [m] and times from
    now [s], of shape (others, n).
    """
    rows = [
        (*other.position, *(other.velocity or (0.0, 0.0)), other.age)
        for other in knowledge.others
    ]
    x, y, u, v, age = np.array(rows).reshape(-1, 5).T[:, :, None]
    x, y, dx, dy = x + u * age, y + v * age, u - own[0], v - own[1]
    square = np.maximum(dx * dx + dy * dy, 1e-9)
    when = np.clip(-(x * dx + y * dy) / square, earliest, HORIZON)
    return np.hypot(x + when * dx, y + when * dy), when
