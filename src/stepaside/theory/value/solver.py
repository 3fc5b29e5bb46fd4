r"""Games on a grid of relative poses, solved by exact steps.

At each decision a robot commits to a motion for a period; its opponent
answers it; and at the end the position of the robot is displaced by up to a
disturbance :math:`\epsilon`. With :math:`T` the motion over a period and
:math:`d` the least distance on the way, the distance that the robot can keep
for ever is

.. math::
    V(x) = \max_w \min_u \min\bigl(d(x, w, u),
    \min_{|\delta| \le \epsilon} V(T(x, w, u) + \delta)\bigr).

Values begin at the distance and only fall. A period of several cells costs
little, and values are interpolated rarely: that keeps barriers sharp, where
schemes that advance less than a cell at a time smooth them out.
"""

from collections.abc import Callable
from math import ceil, inf, log
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import PlanError, check_not_negative, check_positive
from ...core.poses import Array
from .outcomes import OutcomeRules, relax
from .pose_grid import PARTS, PoseGrid, least_within
from .table import ValueTable

MOST = 600  # periods
UNTIL = 1e-4  # change in a period that counts as none, in [m]
INTERPOLATIONS = ("linear", "cubic")


class PursuerLaw(NamedTuple):
    """Pursuer that drives on and turns by eq. (2), in place of answers."""

    speed: float  # [m/s]
    gain: float  # [1/s]
    period: float  # for which the robot commits to a motion, in [s]


def rising(values: Array) -> float:
    """Let values beyond the grid be those of its edge plus the distance."""
    return inf


def solve_game(
    motions: Array,
    answers: Array | PursuerLaw,
    grid: PoseGrid,
    *,
    interpolate: str = "linear",
    disturbance: float = 0.0,
    until: float = UNTIL,
    most: float = inf,
    sag: float = 0.0,
    coarse: int = 1,
    outside: Callable[[Array], float] = rising,
    reach: float = inf,
    periods: int = MOST,
    progress: Callable[[float], object] | None = None,
) -> ValueTable:
    """Compute the distance that a robot can keep from every state.

    Args:
        motions: Motions of the robot; see :func:`.sub_poses`. Shape
            (n, PARTS, 3).
        answers: Those of its opponent, shape (m, PARTS, 3), or its law.
        grid: Poses of the robot in the frame of its opponent.
        interpolate: "linear"; or "cubic" on a grid of one heading.
        disturbance: Radius of the displacement after a motion, in [m].
        until: Change in a period that counts as none, in [m].
        most: Cut-off of the values, in [m].
        sag: Deviation of the distance from that of chords, in [m].
        coarse: Answers from one that is tried to the next, a power of two;
            the best is then refined by halving.
        outside: Returns the value outside the grid from the values of the
            nodes; zero ends the solution, since nothing can be kept.
        reach: Distance from changes within which values may change, in [m].
        periods: Largest number of periods that are looked ahead.
        progress: Called with fractions of the work done since the last call.
    """
    begin, done, first, change = perf_counter(), 0.0, 0.0, inf
    check_not_negative(disturbance, "disturbance", "m")
    check_positive(until, "until", "m")
    if interpolate not in INTERPOLATIONS:
        raise PlanError(
            f"interpolate must be linear or cubic, got {interpolate!r:.40}"
        )
    cubic = interpolate == "cubic"
    if cubic and grid.shape[2] > 1:
        raise PlanError("cubic interpolation needs a grid of one heading")
    v = grid.distances(most)
    rules = make_rules(
        grid, outside(v), sag=sag, cubic=cubic, coarse=coarse, law=answers
    )
    replies = no_answer() if isinstance(answers, PursuerLaw) else answers
    guesses = np.zeros((*grid.shape, 2), np.int32)
    changes, active = np.zeros(grid.shape[:2]), (v < most).any(axis=2)
    active, after = near(active, grid, reach), v
    for n in range(periods if rules.outside else 0):
        after = least_within(v, grid, disturbance)
        after = after.copy() if after is v else after
        relax(v, after, guesses, active, motions, replies, rules, changes)
        rules = rules._replace(outside=outside(v))
        change = float(changes.max())
        first = max(first, change)
        if change < until or not rules.outside:
            break
        if progress is not None:
            part = (n + 1) / periods
            if change < first:
                part = max(part, log(first / change) / log(first / until))
            progress(max(part - done, 0.0))
            done = max(part, done)
        active = near(changes > 0.0, grid, reach)
    if progress is not None:
        progress(1.0 - done)
    after = least_within(v, grid, disturbance)
    seconds = perf_counter() - begin
    return ValueTable(v, after, motions, replies, rules, change, seconds)


def make_rules(
    grid: PoseGrid,
    outside: float,
    *,
    sag: float = 0.0,
    cubic: bool = False,
    coarse: int = 1,
    law: Any = None,
) -> OutcomeRules:
    """Return the rules of outcomes; see :func:`solve_game`."""
    way = rate = 0.0
    if isinstance(law, PursuerLaw):
        part = law.period / PARTS
        way, rate = law.speed * part, law.gain * part
    return OutcomeRules(
        grid.left, grid.right, grid.spacing, *grid.shape, outside, sag, cubic,
        coarse, way, rate,
    )  # fmt: skip


def no_answer() -> Array:
    """Return one answer, at rest."""
    return np.zeros((1, PARTS, 3))


def near(marked: Any, grid: PoseGrid, reach: float) -> Any:
    """Return the columns that have a marked one within a reach, in [m]."""
    if reach == inf:
        return np.ones_like(marked)
    width = ceil(reach / grid.spacing) + 2
    for _ in range(2):  # along x, then along y
        total = np.cumsum(marked, axis=0, dtype=np.int64)
        total = np.pad(total, ((width + 1, width), (0, 0)), mode="edge")
        total[: width + 1] = 0
        found = total[2 * width + 1 :] > total[: -2 * width - 1]
        marked = found.T
    return np.ascontiguousarray(marked)


def step_back(
    after: Array,
    motions: Array,
    answers: Array,
    rules: OutcomeRules,
    grid: PoseGrid,
    start: Array,
    reach: float = inf,
) -> Array:
    """Return values a motion, the best one, before those at its end.

    ``start`` are the values to be lowered, of nodes that cannot change, too;
    the rest is as in :func:`solve_game`.
    """
    found = start.copy()
    guesses = np.zeros((*grid.shape, 2), np.int32)
    active = near((after < after.max()).any(axis=2), grid, reach)
    changes = np.zeros(grid.shape[:2])
    relax(found, after, guesses, active, motions, answers, rules, changes)
    return found
