"""``stepaside bound --against person``: the chauffeur's game."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from .output_files import attempt
from .progress import show_progress
from .tables import print_table, scalar_rows

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..theory.value import ChauffeurGame, ValueTable
    from .bound_options import BoundOptions

RADIUS = 2.5  # of a person's turns by default, in [m]
CONTACT = 0.55  # sum of the half widths of a robot and a person, in [m]
RESPONSE = 0.4  # of a robot that starts to walk by default, in [s]


def person_report(
    options: "BoundOptions", figure: str | None, *, quiet: bool
) -> dict[str, Any]:
    """Solve the game, draw its figure, and return the values for JSON.

    Args:
        options: Options of the command.
        figure: File of the figure, or None.
        quiet: Whether to print lines instead of a progress bar.
    """
    from ..theory.value import solve_chauffeur
    from ..theory.value.chauffeur import standing_table

    game = _game(options)
    capture = CONTACT if options.capture is None else options.capture
    response = RESPONSE if options.response is None else options.response
    cells = [options.grid // 2**n for n in range(options.refine, -1, -1)]
    work = sum(count**2 for count in cells)
    tables = []
    with show_progress("bound", 1.0, quiet=quiet) as bar:
        for count in cells:
            table = solve_chauffeur(
                game,
                count,
                farthest=options.farthest,
                progress=scaled(bar, count**2 / work),
            )
            tables.append((count, table))
    standing = standing_table(table, game, response)
    result = _values(game, capture, tables) | {
        "response_s": response,
        "start_ahead_m": _reach(standing, capture),
    }
    if figure is not None:
        from ..report.value_figures import draw_chauffeur

        drawn = game, table, standing, capture, figure
        if attempt(lambda: draw_chauffeur(*drawn)):
            result["figure"] = figure
    return result


def scaled(bar: Any, share: float) -> "Callable[[float], object]":
    """Return a callback for one table, a share of the work."""
    return lambda part: bar.update(share * part)


def _game(options: "BoundOptions") -> "ChauffeurGame":
    """Return the game of the options."""
    from ..theory.value import ChauffeurGame, SpeedEllipse

    speed = options.evader_speed
    radius = options.person_turning_radius
    return ChauffeurGame(
        options.pursuer_speed,
        RADIUS if radius is None else radius,
        SpeedEllipse(
            options.evader_forward or speed,
            speed,
            options.evader_sideways or speed,
        ),
    )


def _values(
    game: "ChauffeurGame",
    capture: float,
    tables: "list[tuple[int, ValueTable]]",
) -> dict[str, Any]:
    """Return what the tables say, coarsest first, as values for JSON."""
    table = tables[-1][1]
    closed = game.guaranteed_distance
    found = table.rules.outside
    coarse = [each.rules.outside for _, each in tables[:-1]]
    result: dict[str, Any] = {
        "game": asdict(game),
        "period_s": game.period,
        "seconds": table.seconds,
        "guaranteed_m": found,
        "guaranteed_by_cells": {n: t.rules.outside for n, t in tables},
        "grid_error_m": abs(found - coarse[-1]) if coarse else None,
        "closed_form_m": closed,
        "capture_m": capture,
        "avoidable": capture < found,
        "barrier_reach_m": _reach(table, capture),
    }
    return result | _barrier(game, table, capture)


def _barrier(
    game: "ChauffeurGame", table: "ValueTable", capture: float
) -> dict[str, Any]:
    """Compare the barrier with the closed form, where there is one."""
    import numpy as np

    from ..core.errors import PlanError
    from ..theory.value.chauffeur import barrier_of
    from ..theory.value.checks import barrier_offsets

    if not capture < table.rules.outside:
        return {}
    try:
        poses = barrier_of(game, capture)
    except PlanError:
        return {}
    off = np.abs(barrier_offsets(table, poses, capture))
    return {
        "barrier_error_mean_m": float(off.mean()),
        "barrier_error_worst_m": float(off.max()),
        "grid_spacing_m": table.grid.spacing,
    }


def _reach(table: "ValueTable", capture: float) -> float | None:
    """Return the distance up to which contact threatens, in [m].

    None if it threatens from everywhere.
    """
    if capture >= table.rules.outside:
        return None
    import numpy as np

    far = table.grid.distances(np.inf)
    return float(far[table.values < capture].max(initial=capture))


def print_person_bound(result: dict[str, Any]) -> None:
    """Print the result in two columns."""
    print_table(scalar_rows(result, 4))
    if not result["avoidable"]:
        print_table(
            [("no start is safe", "the person can always make contact")]
        )
