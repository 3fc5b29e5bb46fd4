"""``stepaside theory bound``: upper bound of the closest approach."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.errors import PlanError
from ..core.progress import ProgressLine
from ..core.ranges import Range, positive
from ..core.setting import CheckedSettings, setting
from .options import figure_option, json_option, output_file
from .settings import refuse_settings, takes_settings
from .tables import plain, print_table, result_rows
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..theory.value import CarGame, ChauffeurGame, ValueTable

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
    refine: int = setting(
        1,
        "Number of coarser grids, each with half the cells, for the error "
        "estimate",
        Range(0, 3, "1", "coarser ones say nothing", whole=True),
    )
    horizon: float | None = setting(
        None,
        "Time horizon",
        positive("s", None),
        default_text="until nothing changes",
    )

    def cars(self) -> "CarGame":
        """Return the game against a pursuer that steers like a car."""
        from ..theory.value import CarGame

        gain, turn = self.pursuer_gain, 0.0
        if self.against == "any":
            gain, turn = 0.0, self.pursuer_turn or pi * gain
        own = self.evader_turn or 0.0
        return CarGame(self.pursuer_speed, self.evader_speed, gain, turn, own)

    def chauffeur(self) -> "ChauffeurGame":
        """Return the game of a person and an evader of any direction."""
        from ..theory.value import ChauffeurGame

        return ChauffeurGame(
            self.pursuer_speed,
            self.evader_speed,
            self.person_turning_radius or RADIUS,
        )


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

    Solves the game on a grid.
    """
    if settings.against == "person":
        refuse_settings(OF_CARS, "against pursuit or any, got person")
        if output is not None:
            raise click.UsageError("--output requires against pursuit or any")
        result = _bound_person(settings, figure, quiet=as_json)
    else:
        result = _bound_cars(settings, output, figure, quiet=as_json)
    if as_json:
        print_json(plain(result))
        return
    shown = {k: v for k, v in result.items() if k not in ("game", "grid")}
    print_table(result_rows(plain(shown)))
    if result.get("avoidable") is False:
        echo("  no start is safe: the person can always make contact")


def _bound_cars(
    settings: BoundSettings,
    output: Path | None,
    figure: Path | None,
    *,
    quiet: bool,
) -> dict[str, Any]:
    """Solve the game of cars, with its figure; return its values."""
    from ..theory.value import solve_cars

    game, capture, far = settings.cars(), settings.capture, settings.farthest
    if capture is None:
        capture = 0.7 * settings.evader_speed / settings.pursuer_gain
    if far is None:  # beyond the barrier
        units = 4.0 if game.pursuer_gain > 0.0 else 6.0
        far = capture + units * game.unit
    if not capture < far:
        raise click.UsageError(
            f"capture must be below {far:g} [m], the edge of the grid, got "
            f"{capture}"
        )
    solve = partial(solve_cars, game, far, horizon=settings.horizon)
    tables = list(_solve(settings, 3, solve, quiet=quiet).values())
    table = tables[-1]
    result: dict[str, Any] = {
        "game": game,
        "grid": table.grid,
        "seconds_s": table.seconds,
        "falling_m": table.change,
        "capture_m": capture,
        "barrier_reach_m": table.reach(capture),
    }
    if game.identical:
        result["closed_form"] = _closed_form(game, table, capture)
    for coarse, fine in list(pairwise(tables))[-1:]:
        result |= _spread("grid_error", fine.differences(coarse))
    if output is not None:
        table.save(output)
    if figure is not None:
        from ..report.value_figures import draw_bound

        draw_bound(game, table, capture, str(figure))
    return result


def _solve(
    settings: BoundSettings,
    axes: int,
    solve: "Callable[..., ValueTable]",
    *,
    quiet: bool,
) -> "dict[int, ValueTable]":
    """Return tables by cells, each with twice as many as that before.

    ``solve`` is a function of the number of cells along each axis, and of
    ``progress``, which takes the fraction done since its last call.
    """
    counts = [settings.grid // 2**n for n in range(settings.refine, -1, -1)]
    work, found = sum(count**axes for count in counts), {}
    with ProgressLine("bound", 1.0, quiet=quiet) as bar:
        for count in counts:
            share = count**axes / work

            def progress(part: float, share: float = share) -> None:
                bar.update(share * part)

            found[count] = solve(count, progress=progress)
    return found


def _spread(name: str, offsets: Any) -> dict[str, float]:
    """Return mean, 95th percentile and largest of magnitudes, in [m].

    Of a grid they are an estimate and bound no single value.
    """
    import numpy as np

    return {
        f"{name}_m": float(offsets.mean()),
        f"{name}_95_m": float(np.quantile(offsets, 0.95)),
        f"{name}_worst_m": float(offsets.max()),
    }


def _closed_form(
    game: "CarGame", table: "ValueTable", capture: float
) -> dict[str, Any]:
    """Compare the table with the closed-form barrier."""
    import numpy as np

    from ..theory.value.two_cars import barrier_poses

    poses, _ = barrier_poses(capture / game.unit)
    poses = poses * [game.unit, game.unit, 1.0]
    poses = poses[np.hypot(poses[:, 0], poses[:, 1]) <= table.grid.edge]
    values = np.abs(table.value(poses) - capture)
    apart = np.abs(table.offsets(poses, capture))
    return {
        "points": len(values),
        **_spread("value_error", values),
        **_spread("distance_error", apart),
    }


def _bound_person(
    settings: BoundSettings, figure: Path | None, *, quiet: bool
) -> dict[str, Any]:
    """Solve the game of a person, with its figure; return its values."""
    from ..theory.value import solve_chauffeur

    game, capture = settings.chauffeur(), settings.capture or CONTACT
    solve = partial(solve_chauffeur, game, farthest=settings.farthest)
    tables = list(_solve(settings, 2, solve, quiet=quiet).values())
    table, found = tables[-1], tables[-1].grid.outside
    result: dict[str, Any] = {
        "game": game,
        "period_s": game.period,
        "seconds_s": table.seconds,
        "guaranteed_m": found,
        "closed_form_m": game.guaranteed_distance,
        "capture_m": capture,
        "avoidable": capture < found,
        "barrier_reach_m": table.reach(capture) if capture < found else None,
        **_barrier_error(game, table, capture),
    }
    if tables[:-1]:
        result["grid_error_m"] = abs(found - tables[-2].grid.outside)
    if figure is not None:
        from ..report.value_figures import draw_chauffeur

        draw_chauffeur(game, table, capture, str(figure))
    return result


def _barrier_error(
    game: "ChauffeurGame", table: "ValueTable", capture: float
) -> dict[str, float]:
    """Compare the barrier with the closed form, where there is one."""
    import numpy as np

    from ..theory.value.chauffeur import barrier_of

    if not capture < table.grid.outside:
        return {}
    try:
        poses = barrier_of(game, capture)
    except PlanError:
        return {}
    off = np.abs(table.offsets(poses, capture))
    return _spread("barrier_error", off)
