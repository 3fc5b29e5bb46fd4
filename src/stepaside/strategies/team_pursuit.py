"""Pursuit in teams: cyclic, assigned, and from both sides."""

from dataclasses import dataclass, replace
from math import atan2, cos, dist, pi, sin
from typing import Any

import numpy as np

from ..core.poses import Array, wrap_angle
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from .knowledge import STAND, Intent, Knowledge
from .pursuit import PursuitVariant

APART = 0.7  # from teammates from which pursuers turn away, in [m]
TOO_NEAR = 0.45  # to a teammate ahead at which a pursuer halts, in [m]
BESIDE = -0.6  # cosine of the bearing from which a teammate is behind
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class CyclicPursuit(PursuitVariant):
    """Pursuer of the next player of its own team, in the order of names.

    With all players of a team in cyclic pursuit they end on a regular
    polygon. Without a team it pursues the opponent.
    """

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Head for the next player by eq. (2)."""
        own = knowledge.identity
        if own is not None:
            team = {o.identity.name: o for o in knowledge.teammates}
            if not team:
                return STAND, memory
            names = sorted([own.name, *team])
            following = names[(names.index(own.name) + 1) % len(names)]
            knowledge = knowledge.about(team[following])
        return self.pursuit.decide(knowledge, memory)


@dataclass(frozen=True, slots=True)
class AssignedPursuit(PursuitVariant):
    """Pursuer of the evader that its team assigns to it.

    Every pursuer computes the assignment with the least total distance from
    its knowledge; with equal knowledge all compute the same.
    """

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Head for the assigned evader by eq. (2)."""
        evaders = sorted(
            knowledge.opponents, key=lambda other: other.identity.name
        )
        if evaders:
            hunters, own = fellows_of(knowledge), knowledge.identity
            assert own is not None
            costs = np.array(
                [
                    [dist(place, other.position) for other in evaders]
                    for place in hunters.values()
                ]
            )
            row = list(hunters).index(own.name)
            knowledge = knowledge.about(evaders[assign(costs)[row]])
        intent, memory = self.pursuit.decide(knowledge, memory)
        return keep_apart(knowledge, intent), memory


@dataclass(frozen=True, slots=True)
class Pincer(PursuitVariant, CheckedSettings):
    """Pursuer that approaches from one side while teammates take others.

    It aims beside the evader, by an angle seen from there, and straight at
    it from near by.
    """

    spread: float = setting(
        pi / 2,
        "Angle from the middle of the team to its outermost pursuers, seen "
        "from the evader",
        Range(0.0, pi, "rad", "half a turn"),
    )
    near: float = setting(
        0.7,
        "Distance from which it heads straight for the evader",
        Range(0.0, 100.0, "m", "beyond, they never meet"),
    )

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Head for a point beside the evader, or for the evader itself."""
        hunters = fellows_of(knowledge)
        if len(hunters) > 1 and knowledge.distance > self.near:
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
            angle = middle + self.spread * share
            out = 0.6 * knowledge.distance
            knowledge = knowledge.towards(
                u + out * cos(angle), v + out * sin(angle)
            )
        intent, memory = self.pursuit.decide(knowledge, memory)
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
    """Return positions of the own team's pursuers in the frame, in [m].

    They are those of the same role, by name and sorted by it; the own
    position is the origin.
    """
    own = knowledge.identity
    if own is None:
        return {"": (0.0, 0.0)}
    found: dict[str, Point] = {own.name: (0.0, 0.0)}
    for other in knowledge.teammates:
        if other.identity.role is own.role:
            found[other.identity.name] = other.position
    return dict(sorted(found.items()))


def keep_apart(knowledge: Knowledge, intent: Intent) -> Intent:
    """Return an intent that keeps a pursuer away from its teammates.

    Near a teammate ahead or beside the heading turns away from it; nearer
    still, the pursuer halts while the teammate walks on.
    """
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
