"""Solution of the game of a person and a robot; see docs/shield.md.

Outside the grid the value is just above the required one, if it is in a layer
along the edges that no single motion can jump over.
"""

from math import ceil, inf, pi

import numpy as np

from ...core.errors import check_positive, check_within
from ...core.poses import Array
from .closed_forms import guaranteed_distance
from .pose_grid import (
    PoseGrid,
    least_within,
    mirrored,
    sub_poses,
    whole_values,
)
from .shield_game import SEGMENTS, ShieldGame
from .shield_table import ShieldTable
from .solver import make_rules, no_answer, solve_game, step_back
from .table import ValueTable

CELLS = 10  # in the required distance
HEADINGS = 24
STILL = 1e-4  # change in a period that counts as none, of the cut-off
CUT = 1.5  # cut-off of the values over the required distance
SAFE = 1.001  # value outside the grid over the required distance
GROWTH = 1.5  # of the grid, where states outside are not safe
TRIALS = 3


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
    """
    check_positive(least, "least", "m")
    check_within(cells, 4, 100, "cells", "1")
    check_within(headings, 8, 180, "headings", "1")
    check_within(response, 0.0, 10.0, "response", "s")
    check_within(wait, 0.0, 10.0, "wait", "s")
    stands, scale = response + wait, GROWTH
    hopeless = least >= _keepable(game)
    for _ in range(0 if hopeless else TRIALS):
        grid = _cover(game, least, scale * stands, scale, cells, headings)
        layer = _layer(game, stands, grid)
        walking = _solve(game, grid, least, layer)
        if walking.rules.outside and walking.change < _still(least):
            standing, starts = _standing(game, walking, response, wait)
            most = _approach(game, wait, grid) + game.loss_in(wait)
            if _edge(standing, most, grid) >= least:
                return ShieldTable(
                    game, walking, standing, starts, response, wait
                )
        scale *= GROWTH
    grid = PoseGrid(-least, least / cells, (2, 2, headings))
    nothing = solve_game(
        game.motions, no_answer(), grid, most=0.0, outside=lambda _: 0.0
    )
    starts = np.zeros((0, *grid.whole().shape))
    return ShieldTable(game, nothing, nothing.values, starts, response, wait)


def _solve(
    game: ShieldGame, grid: PoseGrid, least: float, layer: float
) -> ValueTable:
    """Solve the game of a walking robot.

    States outside are taken to be just safe, which holds if the states of
    the layer along the edges are; it ends where they are not.
    """
    return solve_game(
        game.motions,
        game.person.walks(game.period),
        grid,
        disturbance=game.disturbance,
        until=_still(least),
        most=CUT * least,
        sag=game.sag(game.period),
        outside=lambda v: SAFE * least * (_edge(v, layer, grid) >= least),
        reach=layer,
    )


def _still(least: float) -> float:
    """Return the change in a period that counts as none, in [m]."""
    return STILL * CUT * least


def _keepable(game: ShieldGame) -> float:
    """Return the distance that a point without turns could keep, in [m]."""
    ratio = game.slowest / game.person.speed
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
    person = game.person
    return (person.speed + person.turn * grid.farthest) * duration


def _edge(v: Array, layer: float, grid: PoseGrid) -> float:
    """Return the least value of a layer along the edges, in [m]."""
    width = ceil(layer / grid.spacing) + 1
    return float(min(v[:width].min(), v[-width:].min(), v[:, -width:].min()))


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
    waits = response + 2.0 * game.period
    if game.turn > 0.0:
        waits += 0.5 * pi / game.turn
    clears = 1.5 * CUT * least / max(game.slowest, 1e-3)
    reach = min(clears, 1.0 / person.turn + 0.5 * waits) + waits
    top = CUT * least
    layer = game.speed * game.period + game.disturbance
    layer += person.speed * (game.period + response)
    swerves = 0.5 * person.turn * person.speed * waits**2
    ahead = top + scale * person.speed * reach + layer
    aside = top + min(scale * swerves, ahead) + layer
    turned = person.turn * (game.period + response) * (ahead + aside)
    return PoseGrid.covering(
        least / cells,
        ahead + turned,
        scale * top + layer + turned,
        aside + turned,
        headings,
    )


def _standing(
    game: ShieldGame, walking: ValueTable, response: float, wait: float
) -> tuple[Array, Array]:
    """Return the value of a robot that stands for a wait, and of its starts.

    A motion begins after any part of the response, of which none, half and
    all are tried. Starts without a response are motions, and are left out.
    """
    grid, after = walking.grid, walking.after
    whole, outside = grid.whole(), walking.rules.outside
    reach = _layer(game, response + wait, grid)
    still = sub_poses([(0.0, 0.0, 0.0)], 1.0)

    def before(
        values: Array, motions: Array, duration: float, grid: PoseGrid
    ) -> Array:
        rules = make_rules(grid, outside, sag=game.sag(duration))
        walks = game.person.walks(duration)
        start = np.full(grid.shape, after.max())
        return step_back(values, motions, walks, rules, grid, start, reach)

    def stood(
        values: Array, duration: float, grid: PoseGrid, jump: float = 0.0
    ) -> Array:
        if duration == 0.0:
            return values
        least = least_within(values, grid, game.loss_in(duration) + jump)
        return before(least, still, duration, grid)

    if response == 0.0:
        starts = np.zeros((0, *whole.shape))
        best = before(after, game.motions, game.period, grid)
        return stood(best, wait, grid, game.jump), starts
    found, ends = list[Array](), whole_values(after)
    for number, motion in enumerate(game.motions):
        mirror = motion * [1.0, -1.0, -1.0]
        twins = np.abs(game.motions[:number] - mirror).max(axis=(1, 2))
        if (twins < 1e-9).any():
            found.append(mirrored(found[int(np.argmin(twins))]))
            continue
        least = later = before(ends, motion[None], game.period, whole)
        for _ in range(SEGMENTS):
            later = stood(later, response / SEGMENTS, whole)
            least = np.minimum(least, later)
        found.append(least)
    starts = np.array(found)
    best = starts.max(axis=0)[:, grid.shape[1] - 1 :]
    best = np.ascontiguousarray(best)
    return stood(best, wait, grid, game.jump), starts
