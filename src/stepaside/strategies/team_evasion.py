"""Evasion of several pursuers: look-ahead over turning sequences."""

from dataclasses import dataclass
from functools import lru_cache
from math import atan2, hypot, inf
from typing import Any

import numpy as np

from ..core.compilation import compiled
from ..core.poses import Array
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..theory import laws
from .evasion import check_release
from .knowledge import STAND, Intent, Knowledge
from .search.step_motion import (
    PAPERS,
    StepRules,
    pair_of,
    step_both,
    step_rules,
)
from .strategy import BackwardStrategy

PIECES = (4, 8, 16)  # steps with a constant turn
TURNS = 7  # values of the turn of each piece
FINAL = 0.2  # weight of the distance at the end beside the closest one
SMALL = 1e-6  # weight of a turn, against ties


@dataclass(frozen=True, slots=True)
class TeamEvasion(BackwardStrategy):
    """Evader that reasons about all pursuers at once.

    It walks backward, and begins the turning sequence after which the
    smallest predicted distance to any pursuer is largest. Each pursuer is
    predicted by eqs. (1)-(2) with the own gait, so that a sequence away from
    one pursuer into another one scores low. This is no guarantee: the
    pursuers may move otherwise.
    """

    safety_radius: float = setting(
        0.8,
        "Distance of the nearest pursuer at which evasion begins",
        Range(1e-3, 1e9, "m", "below a millimetre there is contact"),
    )
    release_distance: float = setting(
        inf,
        "Distance of the nearest pursuer at which evasion ends",
        Range(1e-3, 1e9, "m", "and above safety_radius", also=(inf,)),
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
    """Return the poses of all opponents; of the opponent without a team.

    One of unknown velocity is taken to face the evader. Shape (n, 3).
    """
    rows = []
    for other in knowledge.opponents or (knowledge,):
        (x, y), (u, v) = other.position, other.velocity or (0.0, 0.0)
        faces = hypot(u, v) <= 0.01
        rows.append((x, y, atan2(-y, -x) if faces else atan2(v, u)))
    return np.array(rows)


@lru_cache(maxsize=8)
def candidate_turns(largest: float) -> Array:
    """Return turns [rad] per step: all combinations of three pieces.

    Shape (candidates, steps).
    """
    even = np.linspace(-largest, largest, TURNS)
    grid = np.meshgrid(*[even] * len(PIECES), indexing="ij")
    pieces = np.stack(grid, axis=-1).reshape(-1, len(PIECES))
    turns: Array = np.repeat(pieces, PIECES, axis=1)
    return turns


@compiled
def roll_out_all(
    pursuers: Any, turns: Any, rules: StepRules, least: Any, last: Any
) -> None:
    """Write the least distance to any pursuer, in all and at the end, in [m].

    The evader walks backward from the origin of the frame by turns
    (candidates, steps); pursuers at poses (n, 3) head for it by (1)-(2), with
    its stride and gain.
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
