"""``stepaside theory bound``: upper bound of the closest approach."""

from dataclasses import dataclass
from functools import partial
from math import pi
from pathlib import Path
from typing import Any

import click

from ..core.progress import ProgressLine
from ..core.ranges import Range, positive
from ..core.setting import CheckedSettings, setting
from .options import figure_option, output_file
from .settings import refuse_settings, takes_settings
from .tables import plain, print_table, result_rows
from .terminal import echo, json_option, print_json

AGAINST = ("pursuit", "any", "person")
OF_CARS = ("pursuer_gain", "evader_turn", "horizon")
NAMED = (
    *("against", "pursuer_speed", "evader_speed", "pursuer_gain"),
    *("capture", "grid"),
)
RADIUS = 2.5  # of a person's turns by default, in [m]
CONTACT = 0.55  # sum of the half widths of a robot and a person, in [m]


@dataclass(frozen=True, slots=True)
class BoundSettings(CheckedSettings):
    """Game, grid and solver of the bound."""

    against: str = setting(
        AGAINST[0],
        "The pursuer of eqs. (1)-(2), any with a bounded turning rate, or a "
        "person whom an evader escapes that moves in any direction",
        names=AGAINST,
    )
    pursuer_speed: float = setting(
        1.0, "Speed of the pursuer", positive("m/s")
    )
    evader_speed: float = setting(1.0, "Speed of the evader", positive("m/s"))
    pursuer_gain: float = setting(
        0.5, "Steering gain k of eq. (2)", positive("1/s")
    )
    pursuer_turn: float | None = setting(
        None,
        "Maximum turning rate of the pursuer",
        positive("rad/s", None),
        default_text="pi k",
        needs=("against", "any"),
    )
    evader_turn: float | None = setting(
        None,
        "Maximum turning rate of the evader",
        positive("rad/s", None),
        default_text="the pursuer's",
    )
    person_turning_radius: float | None = setting(
        None,
        "Tightest turning radius of the person",
        positive("m", None),
        default_text="2.5",
        needs=("against", "person"),
    )
    capture: float | None = setting(
        None,
        "Capture distance of the barrier in the output",
        positive("m", None),
        default_text="0.7 v/k",
    )
    farthest: float | None = setting(
        None,
        "Outer edge of the grid",
        positive("m", None),
        default_text="depends on the game",
    )
    grid: int = setting(
        64,
        "Grid cells along each axis",
        Range(16, 200, "1", "more do not fit in memory", whole=True),
    )
    horizon: float | None = setting(
        None,
        "Time horizon",
        positive("s", None),
        default_text="until nothing changes",
    )

    def problem(self) -> tuple[Any, Any, float]:
        """Return the game, the solver of it and the capture distance [m].

        The solver is a function of the number of cells, and of ``progress``.
        """
        from ..theory import value

        speeds, gain = (self.pursuer_speed, self.evader_speed), 0.0
        if self.against == "person":
            radius = self.person_turning_radius or RADIUS
            person = value.ChauffeurGame(*speeds, radius)
            solve = partial(
                value.solve_chauffeur, person, farthest=self.farthest
            )
            return person, solve, self.capture or CONTACT
        turn = self.pursuer_turn or pi * self.pursuer_gain
        if self.against == "pursuit":
            gain, turn = self.pursuer_gain, 0.0
        game = value.CarGame(*speeds, gain, turn, self.evader_turn or 0.0)
        capture = self.capture or 0.7 * self.evader_speed / self.pursuer_gain
        beyond = (4.0 if gain else 6.0) * game.unit  # the barrier
        far = self.farthest or capture + beyond
        if not capture < far:
            raise click.UsageError(
                f"capture must be below {far:g} [m], the edge of the grid, "
                f"got {capture}"
            )
        solve = partial(value.solve_cars, game, far, horizon=self.horizon)
        return game, solve, capture


@click.command("bound")
@takes_settings(NAMED, BoundSettings)
@click.option(
    "--output",
    type=output_file("--output", ".npz"),
    help="Write the table of the value (.npz).",
)
@figure_option()
@json_option
def bound(
    settings: BoundSettings,
    output: Path | None,
    figure: Path | None,
    as_json: bool,
) -> None:
    """Compute the closest approach of a pursuer to an optimal evader.

    Solves the game on a grid, and on one of half the cells, for the error.
    """
    import numpy as np

    person = settings.against == "person"
    if person:
        refuse_settings(OF_CARS, "against pursuit or any, got person")
    game, solve, capture = settings.problem()
    tables = []
    work = 0.2 if person else 1.0 / 9.0  # of the grid of half the cells
    with ProgressLine("bound", 1.0, quiet=as_json) as bar:
        for cells, share in (
            (settings.grid // 2, work),
            (settings.grid, 1.0 - work),
        ):

            def progress(part: float, share: float = share) -> None:
                bar.update(part * share)

            tables.append(solve(cells, progress=progress))
    coarse, table = tables
    kept = table.grid.outside
    result: dict[str, Any] = {
        "game": game,
        "grid": table.grid,
        "seconds_s": table.seconds,
        "falling_m": table.change,
        "capture_m": capture,
        "barrier_reach_m": table.reach(capture) if capture < kept else None,
    }
    if person:
        result["guaranteed_m"] = kept
        result["guaranteed_error_m"] = abs(kept - coarse.grid.outside)
        result["closed_form_m"] = game.guaranteed_distance
        result["avoidable"] = capture < kept
    errors = {"grid_error": table.differences(coarse)}
    barrier = game.barrier(capture)
    if barrier is not None:
        inside = np.hypot(barrier[:, 0], barrier[:, 1]) <= table.grid.edge
        off = table.offsets(barrier[inside], capture)
        errors["barrier_error"] = np.abs(off)
    for name, off in errors.items():
        result[f"{name}_m"] = float(off.mean())
        result[f"{name}_95_m"] = float(np.quantile(off, 0.95))
        result[f"{name}_worst_m"] = float(off.max())
    if output is not None:
        table.save(output)
    if figure is not None:
        from ..report import value_figures

        name = "draw_chauffeur" if person else "draw_bound"
        getattr(value_figures, name)(game, table, capture, figure)
    if as_json:
        print_json(plain(result))
        return
    shown = {k: v for k, v in result.items() if k not in ("game", "grid")}
    rows = result_rows(plain(shown))
    print_table([(_label(name), text) for name, text in rows])
    if result.get("avoidable") is False:
        echo("  no start is safe: the person can always make contact")


def _label(name: str) -> str:
    """Return the label of an error: of most, or of the greatest one."""
    name = name.replace("error 95", "error, 95 % below")
    return name.replace("error worst", "error, greatest")
