"""Output of ``stepaside bound``: JSON values and a printed table."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from .tables import print_table, scalar_rows, table_rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..theory.bound import Bound
    from ..theory.bound.grid_refinement import Refinement

SHOWN = 12  # barrier points in the result
IN_METERS = ("closest", "mean_error", "most", "below", "above")


def describe(table: "Bound", capture: float) -> dict[str, Any]:
    """Return the values of a bound table, for JSON."""
    barrier = table.barrier(capture)
    result: dict[str, Any] = {
        "game": asdict(table.game),
        "grid": asdict(table.grid),
        "horizon_s": table.horizon,
        "seconds": table.seconds,
        "falling_mean_m": table.falling_mean,
        "falling_worst_m": table.falling_worst,
        "capture_m": capture,
        "barrier_reach_m": float(barrier.max()),
        "barrier_mean_m": float(barrier.mean()),
    }
    if table.game.identical:
        result["analytic"] = _analytic(table, capture)
    return result


def _analytic(table: "Bound", capture: float) -> dict[str, Any]:
    """Compare the table with the closed-form barrier."""
    import numpy as np

    from ..theory.bound.bound_checks import PIECES, check_barrier

    found = check_barrier(table, capture)
    values, apart = np.abs(found.value_errors), np.abs(found.distance_errors)
    pieces = np.abs(found.pieces)
    picks = np.linspace(0, len(values) - 1, min(SHOWN, len(values)))
    return {
        "points": len(values),
        "value_error_mean_m": float(values.mean()),
        "value_error_median_m": float(np.median(values)),
        "value_error_worst_m": float(values.max()),
        "distance_error_mean_m": float(apart.mean()),
        "distance_error_median_m": float(np.median(apart)),
        "distance_error_worst_m": float(apart.max()),
        "by_piece": {
            name: float(values[pieces == n].mean())
            for n, name in PIECES.items()
            if (pieces == n).any()
        },
        "barrier": [
            {
                "distance_m": float(found.states[i, 0]),
                "pursuer_error_rad": float(found.states[i, 1]),
                "bearing_rad": float(found.states[i, 2]),
                "analytic_m": capture,
                "table_m": capture + float(found.value_errors[i]),
            }
            for i in picks.astype(int)
        ],
    }


def describe_refinement(rows: "Sequence[Refinement]") -> dict[str, Any]:
    """Return the differences from coarser grids, for JSON.

    The grid error is the mean difference of the last comparison over all
    nodes. It is an estimate and does not bound any single value; the 95th
    percentile, the maximum and the fraction above the mean follow it.
    """
    last = rows[-1] if rows else None
    return {
        "refinement": [
            {
                "cells": row.grid.distances - 1,
                "seconds": row.seconds,
                "mean_difference_m": row.mean,
                "most_difference_m": row.most,
                "worst_difference_m": row.worst,
                "above_mean_share": row.above_mean,
            }
            for row in rows
        ],
        "grid_error_m": last and last.mean,
        "grid_error_95_m": last and last.most,
        "grid_error_worst_m": last and last.worst,
        "grid_error_above_mean_share": last and last.above_mean,
    }


def played_games(table: "Bound", games: int) -> list[dict[str, Any]]:
    """Simulate random games and compare them with the table."""
    from ..theory.bound.bound_checks import check_by_playing

    return [
        {f"{k}_m" if k in IN_METERS else k: v for k, v in asdict(p).items()}
        for p in check_by_playing(table, games)
    ]


def print_bound(result: dict[str, Any]) -> None:
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
