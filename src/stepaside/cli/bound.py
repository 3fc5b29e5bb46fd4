"""``stepaside bound``: upper bound of the closest approach."""

from dataclasses import dataclass
from math import pi, prod
from typing import TYPE_CHECKING, NamedTuple

import click

from ..core.ranges import Range
from ..core.setting import check_settings, setting
from .bound_person import person_report, print_person_bound
from .bound_tables import (
    describe,
    describe_refinement,
    played_games,
    print_bound,
)
from .options.common_options import figure_option, figure_width, json_option
from .options.parameter_types import NameType, OutputFile, positive
from .options.setting_options import refuse_options, takes
from .output_files import attempt, writes_files
from .progress import CELLS, announce_effort, show_progress
from .terminal import print_json

if TYPE_CHECKING:
    from ..theory.bound import Bound, BoundGame, DiscretisationScheme, Grid
    from ..theory.bound.grid_refinement import Refinement

AGAINST = ("pursuit", "any", "person")

OF_CARS = {
    "pursuer_gain",
    "evader_turn",
    "nearest",
    "horizon",
    "games",
    "scheme",
    "output",
}
OF_PERSON = {
    "person_turning_radius",
    "evader_forward",
    "evader_sideways",
    "response",
}


def _schemes() -> tuple[str, ...]:
    from ..theory.bound import DiscretisationScheme

    return tuple(scheme.value for scheme in DiscretisationScheme)


@dataclass(frozen=True, slots=True)
class BoundOptions:
    """Game, grid and solver of ``stepaside bound``."""

    against: str = setting(
        AGAINST[0],
        "The pursuer of eqs. (1)-(2), any with a bounded turning rate, or a "
        "person whom an evader escapes that moves in any direction",
        names=AGAINST,
        option="--against",
    )
    pursuer_speed: float = setting(
        1.0,
        "Speed of the pursuer",
        positive("m/s"),
        option="--pursuer-speed",
    )
    evader_speed: float = setting(
        1.0, "Speed of the evader", positive("m/s"), option="--evader-speed"
    )
    pursuer_gain: float = setting(
        0.5,
        "Steering gain k of eq. (2) {unit}, for --against pursuit",
        positive("1/s"),
        option="--pursuer-gain",
    )
    pursuer_turn: float | None = setting(
        None,
        "Maximum turning rate of the pursuer {unit}, for --against any",
        positive("rad/s", None),
        option="--pursuer-turn",
        default_text="pi k",
    )
    evader_turn: float | None = setting(
        None,
        "Maximum turning rate of the evader",
        positive("rad/s", None),
        option="--evader-turn",
        default_text="the pursuer's",
    )
    person_turning_radius: float | None = setting(
        None,
        "Tightest turning radius of the person {unit}, for --against person",
        positive("m", None),
        option="--person-turning-radius",
        default_text="2.5",
    )
    evader_forward: float | None = setting(
        None,
        "Speed of the evader towards the person {unit}, for --against person",
        positive("m/s", None),
        option="--evader-forward",
        default_text="--evader-speed",
    )
    evader_sideways: float | None = setting(
        None,
        "Speed of the evader across the line of sight {unit}, for --against "
        "person",
        positive("m/s", None),
        option="--evader-sideways",
        default_text="--evader-speed",
    )
    response: float | None = setting(
        None,
        "Time for which a standing evader still stands {unit}, for --against "
        "person",
        Range(0.0, 60.0, "s", "a robot starts sooner", also=(None,)),
        option="--response",
        default_text="0.4",
    )
    capture: float | None = setting(
        None,
        "Capture distance of the barrier in the output",
        positive("m", None),
        option="--capture",
        default_text="0.7 v/k",
    )
    nearest: float | None = setting(
        None,
        "Distance at which a game ends, the inner edge of the grid",
        positive("m", None),
        option="--nearest",
        default_text="half of --capture",
    )
    farthest: float | None = setting(
        None,
        "Outer edge of the grid",
        positive("m", None),
        option="--farthest",
        default_text="depends on the game",
    )
    grid: int = setting(
        64,
        "Grid cells along each axis",
        Range(16, 400, "1", "more do not fit in memory", whole=True),
        option="--grid",
    )
    refine: int = setting(
        1,
        "Number of coarser grids, each with half the cells, for the error "
        "estimate",
        Range(0, 3, "1", "coarser ones say nothing", whole=True),
        option="--refine",
    )
    horizon: float | None = setting(
        None,
        "Time horizon",
        positive("s", None),
        option="--horizon",
        default_text="one full turn at the lowest rate",
    )
    games: int = setting(
        1000,
        "Number of random games simulated to check the table",
        Range(0, 1_000_000, "1", "more take hours", whole=True),
        option="--games",
    )

    def __post_init__(self) -> None:
        """Validate ranges and names."""
        check_settings(self)
        if self.against != "any":
            given = f"--against any, got {self.against}"
            refuse_options({"pursuer_turn"}, given)
        if self.against == "person":
            refuse_options(OF_CARS, "--against pursuit or any, got person")
        else:
            refuse_options(OF_PERSON, f"--against person, got {self.against}")

    def game(self) -> "BoundGame":
        """Return the game."""
        from ..theory.bound import fixed_pursuit_game, two_car_game

        speeds = self.pursuer_speed, self.evader_speed
        if self.against == "pursuit":
            return fixed_pursuit_game(
                *speeds, self.pursuer_gain, self.evader_turn
            )
        turn = self.pursuer_turn
        limit = pi * self.pursuer_gain if turn is None else turn
        return two_car_game(*speeds, limit, self.evader_turn)


@click.command("bound")
@takes(BoundOptions, "options")
@click.option(
    "--scheme",
    type=NameType(_schemes),
    default="weno",
    show_default=True,
    help="Scheme of the solver: fifth order (weno, lax) or first order "
    "(first, first-lax), with Godunov or Lax-Friedrichs flux.",
)
@click.option(
    "--output", type=OutputFile(".npz"), help="Write the table (.npz)."
)
@figure_option()
@figure_width
@json_option
@writes_files
def bound(
    options: BoundOptions,
    scheme: str,
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
    from ..theory.bound import DiscretisationScheme

    capture = options.capture
    if capture is None:
        capture = 0.7 * options.evader_speed / options.pursuer_gain
    problem = _BoundProblem(
        options.game(),
        capture,
        DiscretisationScheme(scheme),
        options.horizon,
    )
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
