"""``stepaside bound``: the best that any evader can do."""

from dataclasses import asdict
from math import pi, prod
from typing import TYPE_CHECKING

import click

from .bound_tables import IN_METERS, describe, print_bound
from .declared.common import FIGURE, figure_width, json_option
from .declared.kinds import NameType, OutputFile
from .declared.option import Declaration
from .effort import CELLS, tell_effort
from .options import METERS, SECONDS, NumberType, print_json
from .outputs import attempt, writes_files

if TYPE_CHECKING:
    from ..bound import BoundGame

SPEED, RATE = NumberType("m/s"), NumberType("rad/s")
TABLE = Declaration(
    "--output", "Write the table (.npz).", kind=OutputFile(".npz")
)
AGAINST = ("pursuit", "any")


def _schemes() -> tuple[str, ...]:
    from ..bound import Scheme

    return tuple(scheme.value for scheme in Scheme)


@click.command("bound")
@click.option(
    "--against",
    type=NameType(lambda: AGAINST),
    default=AGAINST[0],
    show_default=True,
    help="The pursuer of eqs. (1)-(2), or any that turns within its limit.",
)
@click.option(
    "--pursuer-speed",
    type=SPEED,
    default=1.0,
    show_default=True,
    help="Speed of the pursuer [m/s].",
)
@click.option(
    "--evader-speed",
    type=SPEED,
    default=1.0,
    show_default=True,
    help="Speed of the evader [m/s].",
)
@click.option(
    "--pursuer-gain",
    type=NumberType("1/s"),
    default=0.5,
    show_default=True,
    help="Gain k of eq. (2) [1/s], for --against pursuit.",
)
@click.option(
    "--pursuer-turn",
    type=RATE,
    help="Largest turning rate [rad/s], for --against any. [default: pi k]",
)
@click.option(
    "--evader-turn",
    type=RATE,
    help="Largest turning rate of the evader [rad/s]. "
    "[default: the pursuer's]",
)
@click.option(
    "--capture",
    type=METERS,
    help="Distance whose barrier is shown [m]. [default: 0.7 v/k]",
)
@click.option(
    "--nearest",
    type=METERS,
    help="Distance at which a game ends [m]. [default: half of --capture]",
)
@click.option(
    "--farthest", type=METERS, help="Edge of the grid [m]. [default: by game]"
)
@click.option(
    "--grid",
    "cells",
    type=click.IntRange(16, 400),
    default=64,
    show_default=True,
    help="Cells along each axis.",
)
@click.option(
    "--refine",
    type=click.IntRange(0, 3),
    default=1,
    show_default=True,
    help="Coarser grids, of half as many cells each, for the error.",
)
@click.option(
    "--horizon",
    type=SECONDS,
    help="Duration [s]. [default: a turn at slowest]",
)
@click.option(
    "--scheme",
    type=NameType(lambda: _schemes()),
    default="weno",
    show_default=True,
    help="Fifth or first order, by Godunov's or Lax's flux.",
)
@click.option(
    "--games",
    type=click.IntRange(0, 1_000_000),
    default=1000,
    show_default=True,
    help="Random games played to check the table; 0 for none.",
)
@TABLE.option()
@FIGURE.option()
@figure_width
@json_option
@writes_files
def bound(
    against: str,
    pursuer_speed: float,
    evader_speed: float,
    pursuer_gain: float,
    pursuer_turn: float | None,
    evader_turn: float | None,
    capture: float | None,
    nearest: float | None,
    farthest: float | None,
    cells: int,
    refine: int,
    horizon: float | None,
    scheme: str,
    games: int,
    output: str | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Compute how close the pursuer comes to the best evader."""
    from tqdm import tqdm

    from ..bound import (
        Grid,
        Scheme,
        against_any,
        against_pursuit,
        count_steps,
    )
    from ..bound.refine import refine_bound

    if against == "pursuit":
        game = against_pursuit(
            pursuer_speed, evader_speed, pursuer_gain, evader_turn
        )
    else:
        turn = pi * pursuer_gain if pursuer_turn is None else pursuer_turn
        game = against_any(pursuer_speed, evader_speed, turn, evader_turn)
    if capture is None:
        capture = 0.7 * evader_speed / pursuer_gain
    nearest = 0.5 * capture if nearest is None else nearest
    farthest = _edge(game, capture) if farthest is None else farthest
    if not nearest <= capture <= farthest:
        raise click.BadParameter(
            f"must lie in [{nearest:g}, {farthest:g}] [m], got {capture}",
            param_hint="--capture",
        )
    grid = Grid.cube(nearest, farthest, cells)
    steps = count_steps(game, grid, horizon, Scheme(scheme))
    total = prod(grid.shape)
    tell_effort(
        f"a table of {total} cells over {steps} steps", total * steps / CELLS
    )
    look = "{l_bar}{bar}| {elapsed}<{remaining}"
    with tqdm(
        total=1.0, bar_format=look, disable=as_json or None, leave=False
    ) as bar:
        table, rows = refine_bound(
            game,
            grid,
            refine,
            horizon=horizon,
            scheme=Scheme(scheme),
            progress=bar.update,
        )
    result = describe(table, capture)
    result["refinement"] = [
        {
            "cells": row.grid.distances - 1,
            "seconds": row.seconds,
            "mean_difference_m": row.mean,
            "most_difference_m": row.most,
            "worst_difference_m": row.worst,
            "order": row.order,
        }
        for row in rows
    ]
    result["grid_error_m"] = rows[-1].mean if rows else None
    if games:
        from ..bound.checks import check_by_playing

        played = check_by_playing(table, games)
        result["played"] = [
            {
                f"{k}_m" if k in IN_METERS else k: v
                for k, v in asdict(p).items()
            }
            for p in played
        ]
    if output is not None and attempt(lambda: table.save(output)):
        result["output"] = output
    if figure is not None:
        from ..report.bound_figure import draw_bound

        if attempt(lambda: draw_bound(table, capture, figure)):
            result["figure"] = figure
    if as_json:
        print_json(result)
        return
    print_bound(result)


def _edge(game: "BoundGame", capture: float) -> float:
    """Edge of the grid, beyond the barrier of equal players, in [m]."""
    return capture + (4.0 if game.pursuer_gain > 0.0 else 6.0) * game.unit
