"""Interpolation of the bound's value table in compiled loops."""

from math import atan2, hypot, inf
from typing import Any, NamedTuple

import numpy as np

from ...core.compilation import inlined
from ...theory.value.interpolation import OutcomeRules, look_up
from .step_motion import PlayerPair


class PursuitValues(NamedTuple):
    """Optimal closest approach on an open floor, by relative pose.

    Attributes:
        values: Values of the left half of a grid, in length units; empty for
            no table. Shape (x, y, heading).
        left: x of its first node, in length units.
        spacing: Spacing of its positions, in length units.
        unit: Length unit, in [m].
    """

    values: Any
    left: float
    spacing: float
    unit: float


NO_VALUE = PursuitValues(np.zeros((0, 0, 0), dtype=np.float32), 0.0, 1.0, 1.0)
"""No value table after the horizon."""


@inlined
def value_at(table: PursuitValues, both: PlayerPair) -> float:
    """Return the optimal closest approach from a state, in [m]."""
    columns, rows, headings = table.values.shape
    rules = OutcomeRules(
        table.left, 0.0, table.spacing, columns, rows, headings, inf,
        0.0, False, 1, 0.0, 0.0, 0.0,
    )  # fmt: skip
    dx, dy = both.ex - both.px, both.ey - both.py
    x = (both.pc * dx + both.ps * dy) / table.unit
    y = (both.pc * dy - both.ps * dx) / table.unit
    # The evader walks backwards: it moves against its heading.
    theta = atan2(
        both.ec * both.ps - both.es * both.pc,
        -both.ec * both.pc - both.es * both.ps,
    )
    found = look_up(table.values, x, y, theta, rules)
    value: float = min(hypot(dx, dy), found * table.unit)
    return value
