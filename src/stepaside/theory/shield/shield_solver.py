r"""Value of the shield game by relaxation on a grid, in compiled loops.

With :math:`T` the motion over a period, :math:`B` the ball of the disturbance
and :math:`d` the least distance on the way,

.. math::
    V(x) = \max_w \min_u \min\bigl(d(x, w, u),
    \min_{\delta \in B} V(T(x, w, u) + \delta)\bigr).

Values begin at the distance and only fall, so each sweep may use those it has
just lowered. Outside the grid the value is just above the required one, if
it is in a layer along the edges that no single motion can jump over.
"""

from dataclasses import dataclass
from math import ceil, inf, pi, sqrt, tau
from time import perf_counter
from typing import Any

import numpy as np

from ...core.compilation import compiled
from ...core.errors import check_positive, check_within
from ...core.poses import Array
from ..chauffeur.chauffeur_game import guaranteed_distance
from .shield_erosion import eroded_values
from .shield_game import (
    CELLS,
    SEGMENTS,
    OutcomeRules,
    PoseGrid,
    ShieldGame,
    mirrored,
    sub_poses,
    whole_values,
)
from .shield_outcomes import worst_walk
from .shield_table import ShieldTable

HEADINGS = 24
MOST = 600  # sweeps
STILL = 1e-4  # change in a sweep that counts as none, of the cut-off
CUT = 1.5  # cut-off of the values over the required distance
SAFE = 1.001  # value outside the grid over the required distance
GROWTH = 1.5  # of the grid, where states outside are not safe
TRIALS = 3


@compiled
def relax_shield(
    v: Any,
    eroded: Any,
    guesses: Any,
    active: Any,
    motions: Any,
    walks: Any,
    rules: OutcomeRules,
) -> float:
    """Lower the values by one period; return the greatest change.

    Args:
        v: Values of the nodes; lowered in place.
        eroded: Least values within the disturbance.
        guesses: Best motion and worst walk of each node in the last sweep;
            replaced. Shape (*grid.shape, 2).
        active: Input: whether the values at the positions of a column can
            change. Output: whether they did. Shape ``grid.shape[:2]``.
        motions: Motions of the robot. Shape (n, parts, 3).
        walks: Walks of the person. Shape (m, parts, 3).
        rules: Grid of the values, and how the distance is reckoned.
    """
    grid, change = rules.grid, 0.0
    for i in range(grid.shape[0]):
        x = grid.left + grid.spacing * i
        for j in range(grid.shape[1]):
            y = grid.right + grid.spacing * j
            if not active[i, j]:
                continue
            active[i, j] = False
            for k in range(grid.shape[2]):
                pose = (x, y, tau / grid.shape[2] * k)
                kept, answer = guesses[i, j, k, 0], guesses[i, j, k, 1]
                best = -1.0
                for n in range(-1, len(motions)):
                    number = kept if n < 0 else n
                    found, at = worst_walk(
                        eroded, pose, motions[number], walks, answer, best,
                        rules,
                    )  # fmt: skip
                    if found > best:
                        best = found
                        guesses[i, j, k, 0] = number
                        guesses[i, j, k, 1] = at
                    answer = at
                    if best >= v[i, j, k]:
                        break
                lower = min(v[i, j, k], max(best, 0.0))
                if v[i, j, k] > lower:
                    change = max(change, v[i, j, k] - lower)
                    active[i, j] = True
                    v[i, j, k] = lower
    return change


def solve_shield(
    game: ShieldGame,
    least: float,
    *,
    response: float = 0.0,
    wait: float = 0.0,
    cells: int = CELLS,
    headings: int = HEADINGS,
) -> ShieldTable:
    """Compute the distance that the robot can keep from every state.

    Args:
        game: Person, motions and disturbance.
        least: Distance that is required, in [m]; values above 1.5 times it
            are cut off.
        response: Longest time from the decision of a standing robot until its
            motion begins, in [s].
        wait: Time until a standing robot decides again, in [s].
        cells: Number of cells in the required distance.
        headings: Number of headings.

    Returns:
        Tables. States outside the grid may turn out unsafe where the robot is
        too slow, or the required distance too large, for the person.

    Raises:
        PlanError: If a value is out of range.
    """
    check_positive(least, "least", "m")
    check_within(cells, 4, 100, "cells", "1")
    check_within(headings, 8, 180, "headings", "1")
    check_within(response, 0.0, 10.0, "response", "s")
    check_within(wait, 0.0, 10.0, "wait", "s")
    begin = perf_counter()
    grid = PoseGrid(-least, least / cells, (2, 2, headings))
    v = eroded = standing = np.zeros(grid.shape)
    starts, outside = np.zeros((0, *grid.whole().shape)), 0.0
    stands, scale = response + wait, GROWTH
    hopeless = least >= _keepable(game)
    for _ in range(0 if hopeless else TRIALS):
        cover = _cover(game, least, scale * stands, scale, cells, headings)
        layer = _layer(game, stands, cover)
        found, lowest, beyond = _converge_shield(game, cover, least, layer)
        if beyond >= least:
            stood, began = _standing(
                game, cover, lowest, beyond, response, wait
            )
            most = _approach(game, wait, cover) + game.loss_in(wait)
            if _edge(stood, most, cover) >= least:
                grid, v, eroded, standing = cover, found, lowest, stood
                starts, outside = began, beyond
                break
        scale *= GROWTH
    return ShieldTable(
        game, grid, v, eroded, standing, starts, outside, response, wait,
        perf_counter() - begin,
    )  # fmt: skip


def _keepable(game: ShieldGame) -> float:
    """Return the distance that a point without turns could keep, in [m]."""
    ratio = (game.speed - game.disturbance / game.period) / game.person.speed
    if ratio <= 1e-6:
        return 0.0
    if ratio >= 1.0:
        return inf
    return game.person.turning_radius * guaranteed_distance(ratio)


def _layer(game: ShieldGame, stands: float, grid: PoseGrid) -> float:
    """Return the width of the layer that no motion jumps over, in [m].

    A turn of the person moves far states by more than near ones. Before a
    motion the robot may stand for a time, in [s].
    """
    approach = _approach(game, game.period + stands, grid)
    loss = game.disturbance + game.loss_in(stands)
    return approach + game.speed * game.period + loss


def _approach(game: ShieldGame, duration: float, grid: PoseGrid) -> float:
    """Return how far the person moves a state at most in a time, in [m]."""
    person, (x, y, _) = game.person, grid.axes()
    far = sqrt(max(abs(x[0]), abs(x[-1])) ** 2 + y[-1] ** 2)
    return float((person.speed + person.turn * far) * duration)


def _cover(
    game: ShieldGame,
    least: float,
    response: float,
    scale: float,
    cells: int,
    headings: int,
) -> PoseGrid:
    """Return a grid over the states that can be unsafe, and a layer.

    The barrier of an omnidirectional robot reaches at most by its speed times
    the time of a turn by one radian ahead, and by the time that it needs to
    clear the distance; turning and standing come before.
    """
    person = game.person
    speed = max(game.speed - game.disturbance / game.period, 1e-3)
    waits = response + 2.0 * game.period
    if game.turn > 0.0:
        waits += 0.5 * pi / game.turn
    clears = 1.5 * CUT * least / speed
    reach = min(clears, 1.0 / person.turn + 0.5 * waits) + waits
    top = CUT * least
    layer = game.speed * game.period + game.disturbance
    layer += person.speed * (game.period + response)
    swerves = 0.5 * person.turn * person.speed * waits**2
    ahead = top + scale * person.speed * reach + layer
    aside = top + min(scale * swerves, ahead) + layer
    turned = person.turn * (game.period + response) * (ahead + aside)
    ahead, aside = ahead + turned, aside + turned
    behind = scale * top + layer + turned
    spacing = least / cells
    left = -spacing * ceil(behind / spacing)
    shape = (
        ceil((ahead - left) / spacing) + 1,
        ceil(aside / spacing) + 1,
        headings,
    )
    return PoseGrid(left, spacing, shape)


def _edge(v: Array, layer: float, grid: PoseGrid) -> float:
    """Return the least value of a layer along the edges, in [m]."""
    width = ceil(layer / grid.spacing) + 1
    return float(min(v[:width].min(), v[-width:].min(), v[:, -width:].min()))


def _converge_shield(
    game: ShieldGame, grid: PoseGrid, least: float, layer: float
) -> tuple[Array, Array, float]:
    """Relax until nothing changes; return values, eroded and outside.

    States outside are taken to be just safe, which holds if the states of
    the layer along the edges are; it ends where they are not.
    """
    x, y, _ = grid.axes()
    most = CUT * least
    distance = np.minimum(np.hypot(x[:, None], y), most)
    v = np.repeat(distance[:, :, None], grid.shape[2], axis=2)
    walks, sag = game.person.walks(game.period), game.sag(game.period)
    guesses = np.zeros((*grid.shape, 2), dtype=np.int64)
    changed, outside = (v < most).any(axis=2), SAFE * least
    rules = OutcomeRules(grid, outside, sag)
    for _ in range(MOST):
        eroded = eroded_values(v, grid, game.disturbance)
        active = _near(changed, ceil(layer / grid.spacing) + 2)
        change = relax_shield(
            v, eroded, guesses, active, game.motions, walks, rules
        )
        changed = active
        if _edge(v, layer, grid) < least:
            return v, eroded, 0.0
        if change < STILL * most:
            break
    else:  # values may still fall
        return v, eroded, 0.0
    return v, eroded_values(v, grid, game.disturbance), outside


def _near(marked: Any, width: int) -> Any:
    """Return the nodes that have a marked one within a width. Shape (n, m)."""
    for _ in range(2):  # along x, then along y
        total = np.cumsum(marked, axis=0, dtype=np.int64)
        total = np.pad(total, ((width + 1, width), (0, 0)), mode="edge")
        total[: width + 1] = 0
        found = total[2 * width + 1 :] > total[: -2 * width - 1]
        marked = found.T
    return np.ascontiguousarray(marked)


@dataclass(frozen=True, slots=True)
class _Backup:
    """Values of the begin of motions from those of their end.

    Attributes:
        game: Person, motions and disturbance.
        outside: Value outside the grid.
        most: Cut-off of the values, in [m].
        reach: Nodes beyond those below it that can come to be below it.
    """

    game: ShieldGame
    outside: float
    most: float
    reach: int

    def before(
        self, values: Array, motions: Array, duration: float, grid: PoseGrid
    ) -> Array:
        """Return the values of the begin of the best motion."""
        found = np.full(grid.shape, self.most)
        guesses = np.zeros((*grid.shape, 2), dtype=np.int64)
        near = _near((values < self.most).any(axis=2), self.reach)
        walks = self.game.person.walks(duration)
        rules = OutcomeRules(grid, self.outside, self.game.sag(duration))
        relax_shield(found, values, guesses, near, motions, walks, rules)
        return found

    def stand(
        self,
        values: Array,
        duration: float,
        grid: PoseGrid,
        jump: float = 0.0,
    ) -> Array:
        """Return the values of a robot that stands for a while."""
        if duration == 0.0:
            return values
        loss = self.game.loss_in(duration) + jump
        still = sub_poses([(0.0, 0.0, 0.0)], 1.0)
        eroded = eroded_values(values, grid, loss)
        return self.before(eroded, still, duration, grid)

    def starts(self, eroded: Array, response: float, whole: PoseGrid) -> Array:
        """Return the values of starts with each motion, on a whole grid.

        A motion begins after any part of the response, of which none, half
        and all are tried.
        """
        game, found = self.game, list[Array]()
        ends = whole_values(eroded)
        for number, motion in enumerate(game.motions):
            mirror = motion * [1.0, -1.0, -1.0]
            twins = np.abs(game.motions[:number] - mirror).max(axis=(1, 2))
            if (twins < 1e-9).any():
                found.append(mirrored(found[int(np.argmin(twins))]))
                continue
            least = after = self.before(ends, motion[None], game.period, whole)
            for _ in range(SEGMENTS):
                after = self.stand(after, response / SEGMENTS, whole)
                least = np.minimum(least, after)
            found.append(least)
        return np.array(found)


def _standing(
    game: ShieldGame,
    grid: PoseGrid,
    eroded: Array,
    outside: float,
    response: float,
    wait: float,
) -> tuple[Array, Array]:
    """Return the value of a robot that stands for a wait, and of its starts.

    It commits to its first motion when it starts. Starts without a response
    are motions, and are left out.
    """
    reach = ceil(_layer(game, response + wait, grid) / grid.spacing) + 2
    backup = _Backup(game, outside, float(eroded.max()), reach)
    whole = grid.whole()
    starts = np.zeros((0, *whole.shape))
    if response == 0.0:
        best = backup.before(eroded, game.motions, game.period, grid)
    else:
        starts = backup.starts(eroded, response, whole)
        best = starts.max(axis=0)[:, grid.shape[1] - 1 :]
    best = np.ascontiguousarray(best)
    return backup.stand(best, wait, grid, game.jump), starts
