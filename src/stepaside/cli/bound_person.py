"""``stepaside theory bound --against person``: the chauffeur's game."""

from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .bound_grids import solve_grids
from .tables import print_table, scalar_rows
from .terminal import print_json

if TYPE_CHECKING:
    from ..theory.value import ChauffeurGame, ValueTable

RADIUS = 2.5  # of a person's turns by default, in [m]
CONTACT = 0.55  # sum of the half widths of a robot and a person, in [m]
RESPONSE = 0.4  # of a robot that starts to walk by default, in [s]


def bound_person(settings: Any, figure: Path | None, *, as_json: bool) -> None:
    """Solve the game, print the values and draw the figure.

    Args:
        settings: Settings of the bound.
        figure: File of the figure, or None.
        as_json: Whether to print one JSON object.
    """
    from ..theory.value import ChauffeurGame, SpeedEllipse, solve_chauffeur
    from ..theory.value.chauffeur import standing_table

    speed = settings.evader_speed
    game = ChauffeurGame(
        settings.pursuer_speed,
        settings.person_turning_radius or RADIUS,
        SpeedEllipse(
            settings.evader_forward or speed,
            speed,
            settings.evader_sideways or speed,
        ),
    )
    capture, response = settings.capture or CONTACT, settings.response
    response = RESPONSE if response is None else response
    solve = partial(solve_chauffeur, game, farthest=settings.farthest)
    tables = solve_grids(settings, 2, solve, quiet=as_json)
    table = tables[settings.grid]
    standing = standing_table(table, game, response)
    result = _values(game, capture, tables) | {
        "response_s": response,
        "start_ahead_m": _reach(standing, capture),
    }
    if as_json:
        print_json(result)
    else:
        print_table(scalar_rows(result, 4))
        if not result["avoidable"]:
            text = "the person can always make contact"
            print_table([("no start is safe", text)])
    if figure is not None:
        from ..report.value_figures import draw_chauffeur

        draw_chauffeur(game, table, standing, capture, str(figure))


def _values(
    game: "ChauffeurGame", capture: float, tables: "dict[int, ValueTable]"
) -> dict[str, Any]:
    """Return what the tables say, coarsest first, as values for JSON."""
    *coarse, table = tables.values()
    found = table.rules.outside
    error = abs(found - coarse[-1].rules.outside) if coarse else None
    result: dict[str, Any] = {
        "game": asdict(game),
        "period_s": game.period,
        "seconds": table.seconds,
        "guaranteed_m": found,
        "guaranteed_by_cells": {
            n: each.rules.outside for n, each in tables.items()
        },
        "grid_error_m": error,
        "closed_form_m": game.guaranteed_distance,
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
