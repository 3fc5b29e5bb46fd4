"""``stepaside bound``: upper bound of the closest approach."""

from typing import TYPE_CHECKING

import click

from .bound_options import BoundOptions
from .bound_person import person_report, print_person_bound, scaled
from .bound_tables import (
    describe,
    describe_refinement,
    played_games,
    print_bound,
)
from .options.common_options import figure_option, figure_width, json_option
from .options.parameter_types import OutputFile
from .options.settings_options import takes
from .output_files import attempt, writes_files
from .progress import CELLS, announce_effort, show_progress
from .terminal import print_json

if TYPE_CHECKING:
    from ..theory.value import CarGame, ValueTable

SWEEPS = 15  # steps of each cell of a cube


@click.command("bound")
@takes(BoundOptions, "options")
@click.option(
    "--output", type=OutputFile(".npz"), help="Write the table (.npz)."
)
@figure_option()
@figure_width
@json_option
@writes_files
def bound(
    options: BoundOptions,
    output: str | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Compute the closest approach of a pursuer to an optimal evader.

    Solves the game on a grid.
    """
    if options.against == "person":
        report = person_report(options, figure, quiet=as_json)
        print_json(report) if as_json else print_person_bound(report)
        return
    game, capture = options.game(), options.capture
    if capture is None:
        capture = 0.7 * options.evader_speed / options.pursuer_gain
    far = _edge(game, capture, options.farthest)
    tables = _solve(game, far, options, quiet=as_json)
    table = tables[-1]
    result = describe(game, table, capture) | describe_refinement(tables)
    if options.games:
        reach = 0.5 * capture, 0.75 * far
        result["played"] = played_games(game, table, reach, options.games)
    if output is not None and attempt(lambda: table.save(output)):
        result["output"] = output
    if figure is not None:
        from ..report.value_figures import draw_bound

        if attempt(lambda: draw_bound(game, table, capture, figure)):
            result["figure"] = figure
    if as_json:
        print_json(result)
        return
    print_bound(result)


def _solve(
    game: "CarGame", far: float, options: BoundOptions, *, quiet: bool
) -> "list[ValueTable]":
    """Return tables of a game, each with twice the cells of that before."""
    from ..theory.value import solve_cars

    cells = [options.grid // 2**n for n in range(options.refine, -1, -1)]
    work = sum(count**3 for count in cells)
    announce_effort(
        f"a table of {options.grid} cells along each axis",
        SWEEPS * options.grid**3 / CELLS,
    )
    look = "{l_bar}{bar}| {elapsed}<{remaining}"
    with show_progress("bound", 1.0, bar_format=look, quiet=quiet) as bar:
        return [
            solve_cars(
                game,
                far,
                count,
                horizon=options.horizon,
                progress=scaled(bar, count**3 / work),
            )
            for count in cells
        ]


def _edge(game: "CarGame", capture: float, given: float | None) -> float:
    """Return the edge of the grid, by default beyond the barrier, in [m]."""
    units = 4.0 if game.pursuer_gain > 0.0 else 6.0
    far = capture + units * game.unit if given is None else given
    if not capture < far:
        raise click.BadParameter(
            f"must be below {far:g} [m], the edge of the grid, got {capture}",
            param_hint="--capture",
        )
    return far
