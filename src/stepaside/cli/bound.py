"""``stepaside theory bound``: upper bound of the closest approach."""

from dataclasses import asdict, dataclass
from functools import partial
from itertools import pairwise
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..games.unicycle_settings import positive
from .bound_grids import solve_grids
from .options import figure_option, figure_width, json_option, output_file
from .settings import refuse_settings, takes_settings
from .tables import print_table, scalar_rows, table_rows
from .terminal import print_json

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..theory.value import CarGame, ValueTable

AGAINST = ("pursuit", "any", "person")
OF_CARS = ("pursuer_gain", "evader_turn", "horizon", "games")
IN_METERS = ("closest", "mean_error", "most", "below", "above")
NAMED = (
    *("against", "pursuer_speed", "evader_speed", "pursuer_gain"),
    *("capture", "grid", "games"),
)


@dataclass(frozen=True, slots=True)
class BoundSettings:
    """Game, grid and solver of the bound."""

    against: str = setting(
        AGAINST[0],
        "The pursuer of eqs. (1)-(2), any with a bounded turning rate, or a "
        "person whom an evader escapes that moves in any direction",
        names=AGAINST,
    )
    pursuer_speed: float = setting(
        1.0,
        "Speed of the pursuer",
        positive("m/s"),
    )
    evader_speed: float = setting(
        1.0,
        "Speed of the evader",
        positive("m/s"),
    )
    pursuer_gain: float = setting(
        0.5,
        "Steering gain k of eq. (2)",
        positive("1/s"),
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
    evader_forward: float | None = setting(
        None,
        "Speed of the evader towards the person",
        positive("m/s", None),
        default_text="evader_speed",
        needs=("against", "person"),
    )
    evader_sideways: float | None = setting(
        None,
        "Speed of the evader across the line of sight",
        positive("m/s", None),
        default_text="evader_speed",
        needs=("against", "person"),
    )
    response: float | None = setting(
        None,
        "Time for which a standing evader still stands",
        Range(0.0, 60.0, "s", "a robot starts sooner", also=(None,)),
        default_text="0.4",
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
    games: int = setting(
        1000,
        "Number of random games simulated to check the table",
        Range(0, 1_000_000, "1", "more take hours", whole=True),
    )

    def __post_init__(self) -> None:
        """Validate ranges and names."""
        check_settings(self)

    def game(self) -> "CarGame":
        """Return the game against a pursuer that steers like a car."""
        from ..theory.value import CarGame

        gain, turn = self.pursuer_gain, 0.0
        if self.against == "any":
            gain, turn = 0.0, self.pursuer_turn or pi * gain
        own = self.evader_turn or 0.0
        return CarGame(self.pursuer_speed, self.evader_speed, gain, turn, own)


@click.command("bound")
@takes_settings(NAMED, settings=BoundSettings)
@click.option(
    "--output",
    type=output_file("--output", ".npz"),
    help="Write the table of the value (.npz).",
)
@figure_option()
@figure_width
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
        from .bound_person import bound_person

        refuse_settings(OF_CARS, "against pursuit or any, got person")
        if output is not None:
            raise click.UsageError("--output requires against pursuit or any")
        bound_person(settings, figure, as_json=as_json)
        return
    game, capture, far = settings.game(), settings.capture, settings.farthest
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
    from ..theory.value import solve_cars

    solve = partial(solve_cars, game, far, horizon=settings.horizon)
    tables = list(solve_grids(settings, 3, solve, quiet=as_json).values())
    table = tables[-1]
    result = _describe(game, table, capture) | _describe_refinement(tables)
    if settings.games:
        reach = 0.5 * capture, 0.75 * far
        result["played"] = _play(game, table, reach, settings.games)
    print_json(result) if as_json else _print(result)
    if output is not None:
        table.save(output)
    if figure is not None:
        from ..report.value_figures import draw_bound

        draw_bound(game, table, capture, str(figure))


def _describe(
    game: "CarGame", table: "ValueTable", capture: float
) -> dict[str, Any]:
    """Return the values of a bound table, for JSON."""
    from ..theory.value.two_cars import barrier

    reach = barrier(table, capture)
    result: dict[str, Any] = {
        "game": asdict(game),
        "grid": table.grid._asdict(),
        "seconds": table.seconds,
        "falling_m": table.change,
        "capture_m": capture,
        "barrier_reach_m": float(reach.max()),
        "barrier_mean_m": float(reach.mean()),
    }
    if game.identical:
        result["analytic"] = _analytic(game, table, capture)
    return result


def _analytic(
    game: "CarGame", table: "ValueTable", capture: float
) -> dict[str, Any]:
    """Compare the table with the closed-form barrier."""
    import numpy as np

    from ..theory.value.checks import barrier_offsets
    from ..theory.value.closed_forms import barrier_poses

    poses, _ = barrier_poses(capture / game.unit)
    poses = poses * [game.unit, game.unit, 1.0]
    poses = poses[np.hypot(poses[:, 0], poses[:, 1]) <= table.grid.edge]
    values = np.abs(table.value(poses) - capture)
    apart = np.abs(barrier_offsets(table, poses, capture))
    return {
        "points": len(values),
        "value_error_mean_m": float(values.mean()),
        "value_error_median_m": float(np.median(values)),
        "value_error_worst_m": float(values.max()),
        "distance_error_mean_m": float(apart.mean()),
        "distance_error_median_m": float(np.median(apart)),
        "distance_error_worst_m": float(apart.max()),
    }


def _describe_refinement(tables: "Sequence[ValueTable]") -> dict[str, Any]:
    """Return the differences from coarser tables, for JSON.

    The grid error is the mean difference of the last comparison over all
    nodes. It is an estimate and does not bound any single value; the 95th
    percentile, the maximum and the fraction above the mean follow it.
    """
    import numpy as np

    from ..theory.value.checks import differences

    rows = []
    for coarse, fine in pairwise(tables):
        off = differences(coarse, fine)
        rows.append(
            {
                "cells": coarse.grid.shape[1] - 1,
                "seconds": coarse.seconds,
                "mean_difference_m": float(off.mean()),
                "most_difference_m": float(np.quantile(off, 0.95)),
                "worst_difference_m": float(off.max()),
                "above_mean_share": float((off > off.mean()).mean()),
            }
        )
    last = rows[-1] if rows else {}
    return {
        "refinement": rows,
        "grid_error_m": last.get("mean_difference_m"),
        "grid_error_95_m": last.get("most_difference_m"),
        "grid_error_worst_m": last.get("worst_difference_m"),
        "grid_error_above_mean_share": last.get("above_mean_share"),
    }


def _play(
    game: "CarGame",
    table: "ValueTable",
    reach: tuple[float, float],
    games: int,
) -> list[dict[str, Any]]:
    """Simulate games from distances within reach, and compare the table."""
    from ..theory.value.checks import (
        compare_evaders,
        draw_starts,
        reference_evaders,
    )

    starts = draw_starts(*reach, games)
    rows = compare_evaders(game, table, reference_evaders(game), starts)
    return [
        {f"{k}_m" if k in IN_METERS else k: v for k, v in row.items()}
        for row in rows
    ]


def _print(result: dict[str, Any]) -> None:
    """Print the result in two columns."""
    renamed = {"seconds": "seconds_s"}
    rows = scalar_rows({renamed.get(k, k): v for k, v in result.items()}, 4)
    analytic = result.get("analytic", {})
    numbers = (n for n, v in analytic.items() if isinstance(v, int | float))
    found = table_rows(analytic, numbers, 4)
    rows += [(f"closed form: {name}", text) for name, text in found]
    for row in result["refinement"]:
        off = f"{row['mean_difference_m']:.4g} m"
        rows.append((f"difference to {row['cells']} cells", off))
    for played in result.get("played", []):
        text = f"{played['over_bound']:.3f} of the bound"
        text += f", at most {played['above_m']:.3g} m above it"
        rows.append((f"simulated {played['name']}", text))
    print_table(rows)
