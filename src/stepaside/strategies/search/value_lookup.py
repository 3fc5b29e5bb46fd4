"""Interpolation of the bound's value table in compiled loops."""

from math import atan2, hypot, pi, tau
from typing import Any, NamedTuple

import numpy as np

from ...core.compilation import inlined
from .step_motion import PlayerPair


class PursuitValues(NamedTuple):
    """Optimal closest approach on an open floor, by relative state.

    Attributes:
        values: Values, in length units. Shape (a, r, psi), with one more
            node on both sides of each periodic axis; empty for no table.
        near: Least distance of its nodes, in length units.
        step: Spacing of the distances, in length units.
        unit: Length unit, in [m].
    """

    values: Any
    near: float
    step: float
    unit: float


NO_VALUE = PursuitValues(np.zeros((0, 0, 0), dtype=np.float32), 0.0, 1.0, 1.0)
"""No value table after the horizon."""


@inlined
def value_at(table: PursuitValues, both: PlayerPair) -> float:
    """Return the optimal closest approach from a state, in [m]."""
    values = table.values
    dx, dy = both.ex - both.px, both.ey - both.py
    distance = hypot(dx, dy)
    r = (distance / table.unit - table.near) / table.step
    if r <= 0.0:
        return distance
    a = atan2(both.pc * dy - both.ps * dx, both.pc * dx + both.ps * dy)
    psi = atan2(both.es * dx - both.ec * dy, -both.ec * dx - both.es * dy)
    na, nr, npsi = values.shape
    beyond = max(r - (nr - 1.0), 0.0)
    u = (a + pi) * ((na - 2) / tau) + 0.5
    v = min(r, nr - 1.0)
    w = (psi + pi) * ((npsi - 2) / tau) + 0.5
    i = min(int(u), na - 2)
    j = min(int(v), nr - 2)
    k = min(int(w), npsi - 2)
    u, v, w = u - i, v - j, w - k
    low = (1.0 - w) * values[i, j, k] + w * values[i, j, k + 1]
    up = (1.0 - w) * values[i, j + 1, k] + w * values[i, j + 1, k + 1]
    before = (1.0 - v) * low + v * up
    low = (1.0 - w) * values[i + 1, j, k] + w * values[i + 1, j, k + 1]
    up = (1.0 - w) * values[i + 1, j + 1, k] + w * values[i + 1, j + 1, k + 1]
    after = (1.0 - v) * low + v * up
    found = (1.0 - u) * before + u * after + beyond * table.step
    value: float = min(distance, found * table.unit)
    return value
