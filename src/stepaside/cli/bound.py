"""``stepaside bound``: upper bound of the closest approach."""

from math import prod
from typing import TYPE_CHECKING, NamedTuple

import click

from .bound_options import BoundOptions
from .bound_person import person_report, print_person_bound
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
    from ..theory.bound import Bound, BoundGame, Grid
    from ..theory.bound.grid_refinement import Refinement


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

    Solves the Hamilton-Jacobi equation of the game on a grid.
    """
    if options.against == "person":
        report = person_report(options, figure, quiet=as_json)
        print_json(report) if as_json else print_person_bound(report)
        return
    capture = options.capture
    if capture is None:
        capture = 0.7 * options.evader_speed / options.pursuer_gain
    problem = _BoundProblem(options.game(), capture, options.horizon)
    grid = problem.grid(options.nearest, options.farthest, options.grid)
    table, rows = problem.solve(grid, options.refine, quiet=as_json)
    result = describe(table, capture) | describe_refinement(rows)
    if options.games:
        result["played"] = played_games(table, options.games)
    if output is not None and attempt(lambda: table.save(output)):
        result["output"] = output
    if figure is not None:
        from ..report.value_function_figure import draw_bound

        if attempt(lambda: draw_bound(table, problem.capture, figure)):
            result["figure"] = figure
    if as_json:
        print_json(result)
        return
    print_bound(result)


class _BoundProblem(NamedTuple):
    """Game and solver settings.

    Attributes:
        game: Game to solve.
        capture: Capture distance of the barrier, in [m].
        horizon: Time horizon, in [s]; one full turn if None.
    """

    game: "BoundGame"
    capture: float
    horizon: float | None

    def grid(
        self, nearest: float | None, farthest: float | None, cells: int
    ) -> "Grid":
        """Return the grid; edges in [m] by default beyond the barrier."""
        from ..theory.bound import Grid

        low = 0.5 * self.capture if nearest is None else nearest
        high = _edge(self.game, self.capture) if farthest is None else farthest
        if not low <= self.capture <= high:
            raise click.BadParameter(
                f"must lie in [{low:g}, {high:g}] [m], got {self.capture}",
                param_hint="--capture",
            )
        return Grid.cube(low, high, cells)

    def solve(
        self, grid: "Grid", refine: int, *, quiet: bool
    ) -> "tuple[Bound, tuple[Refinement, ...]]":
        """Return the table, and its differences from coarser ones."""
        from ..theory.bound import count_steps
        from ..theory.bound.grid_refinement import refine_bound

        steps = count_steps(self.game, grid, self.horizon)
        total = prod(grid.shape)
        announce_effort(
            f"a table of {total} cells over {steps} steps",
            total * steps / CELLS,
        )
        look = "{l_bar}{bar}| {elapsed}<{remaining}"
        with show_progress("bound", 1.0, bar_format=look, quiet=quiet) as bar:
            return refine_bound(
                self.game,
                grid,
                refine,
                horizon=self.horizon,
                progress=bar.update,
            )


def _edge(game: "BoundGame", capture: float) -> float:
    """Return a grid edge beyond the barrier of equal players, in [m]."""
    return capture + (4.0 if game.pursuer_gain > 0.0 else 6.0) * game.unit
