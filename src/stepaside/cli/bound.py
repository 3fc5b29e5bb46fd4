"""``stepaside bound``: upper bound of the closest approach."""

from math import pi, prod
from typing import TYPE_CHECKING, NamedTuple

import click

from .bound_tables import (
    describe,
    describe_refinement,
    played_games,
    print_bound,
)
from .effort_estimate import CELLS, announce_effort
from .options.common_options import figure_option, figure_width, json_option
from .options.parameter_types import (
    METERS,
    SECONDS,
    NameType,
    NumberType,
    OutputFile,
)
from .options.setting_options import refuse_options
from .output_files import attempt, writes_files
from .progress import show_progress
from .terminal import print_json

if TYPE_CHECKING:
    from ..theory.bound import Bound, BoundGame, DiscretisationScheme, Grid
    from ..theory.bound.grid_refinement import Refinement

SPEED, RATE = NumberType("m/s"), NumberType("rad/s")
AGAINST = ("pursuit", "any")


def _schemes() -> tuple[str, ...]:
    from ..theory.bound import DiscretisationScheme

    return tuple(scheme.value for scheme in DiscretisationScheme)


@click.command("bound")
@click.option(
    "--against",
    type=NameType(lambda: AGAINST),
    default=AGAINST[0],
    show_default=True,
    help="The pursuer of eqs. (1)-(2), or any with a bounded turning rate.",
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
    help="Steering gain k of eq. (2) [1/s], for --against pursuit.",
)
@click.option(
    "--pursuer-turn",
    type=RATE,
    help="Maximum turning rate of the pursuer [rad/s], for --against any.  "
    "[default: pi k]",
)
@click.option(
    "--evader-turn",
    type=RATE,
    help="Maximum turning rate of the evader [rad/s].  "
    "[default: the pursuer's]",
)
@click.option(
    "--capture",
    type=METERS,
    help="Capture distance of the barrier in the output [m].  "
    "[default: 0.7 v/k]",
)
@click.option(
    "--nearest",
    type=METERS,
    help="Distance at which a game ends, the inner edge of the grid [m].  "
    "[default: half of --capture]",
)
@click.option(
    "--farthest",
    type=METERS,
    help="Outer edge of the grid [m].  [default: depends on the game]",
)
@click.option(
    "--grid",
    "cells",
    type=click.IntRange(16, 400),
    default=64,
    show_default=True,
    help="Grid cells along each axis.",
)
@click.option(
    "--refine",
    type=click.IntRange(0, 3),
    default=1,
    show_default=True,
    help="Number of coarser grids, each with half the cells, for the error "
    "estimate.",
)
@click.option(
    "--horizon",
    type=SECONDS,
    help="Time horizon [s].  [default: one full turn at the lowest rate]",
)
@click.option(
    "--scheme",
    type=NameType(lambda: _schemes()),
    default="weno",
    show_default=True,
    help="Scheme of the solver: fifth order (weno, lax) or first order "
    "(first, first-lax), with Godunov or Lax-Friedrichs flux.",
)
@click.option(
    "--games",
    type=click.IntRange(0, 1_000_000),
    default=1000,
    show_default=True,
    help="Number of random games simulated to check the table.",
)
@click.option(
    "--output", type=OutputFile(".npz"), help="Write the table (.npz)."
)
@figure_option()
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
    """Compute the closest approach of a pursuer to an optimal evader.

    Solves the Hamilton-Jacobi equation of the game on a grid.
    """
    from ..theory.bound import DiscretisationScheme

    if against == "pursuit":
        refuse_options({"pursuer_turn"}, "--against any, got pursuit")
    turn = pi * pursuer_gain if pursuer_turn is None else pursuer_turn
    problem = _BoundProblem(
        _game_of(
            against,
            (pursuer_speed, evader_speed),
            (pursuer_gain, turn, evader_turn),
        ),
        0.7 * evader_speed / pursuer_gain if capture is None else capture,
        DiscretisationScheme(scheme),
        horizon,
    )
    grid = problem.grid(nearest, farthest, cells)
    table, rows = problem.solve(grid, refine, quiet=as_json)
    result = describe(table, problem.capture) | describe_refinement(rows)
    if games:
        result["played"] = played_games(table, games)
    if output is not None and attempt(lambda: table.save(output)):
        result["output"] = output
    if figure is not None:
        from ..report.bound_figure import draw_bound

        if attempt(lambda: draw_bound(table, problem.capture, figure)):
            result["figure"] = figure
    if as_json:
        print_json(result)
        return
    print_bound(result)


def _game_of(
    against: str,
    speeds: tuple[float, float],
    turning: tuple[float, float, float | None],
) -> "BoundGame":
    """Return the game for gain, pursuer's and evader's turning limits."""
    from ..theory.bound import fixed_pursuit_game, two_car_game

    gain, limit, evader_turn = turning
    if against == "pursuit":
        return fixed_pursuit_game(*speeds, gain, evader_turn)
    return two_car_game(*speeds, limit, evader_turn)


class _BoundProblem(NamedTuple):
    """Game and solver settings.

    Attributes:
        game: Game to solve.
        capture: Capture distance of the barrier, in [m].
        scheme: Scheme of the solver.
        horizon: Time horizon, in [s]; one full turn if None.
    """

    game: "BoundGame"
    capture: float
    scheme: "DiscretisationScheme"
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

        steps = count_steps(self.game, grid, self.horizon, self.scheme)
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
                scheme=self.scheme,
                progress=bar.update,
            )


def _edge(game: "BoundGame", capture: float) -> float:
    """Return a grid edge beyond the barrier of equal players, in [m]."""
    return capture + (4.0 if game.pursuer_gain > 0.0 else 6.0) * game.unit
