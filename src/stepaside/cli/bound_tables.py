"""Output of ``stepaside bound``: JSON values and a printed table."""

from dataclasses import asdict
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from .tables import print_table, scalar_rows, table_rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..theory.value import CarGame, ValueTable

SHOWN = 12  # barrier points in the result
IN_METERS = ("closest", "mean_error", "most", "below", "above")


def describe(
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
    from ..theory.value.closed_forms import PIECES, barrier_poses

    poses, pieces = barrier_poses(capture / game.unit)
    poses = poses * [game.unit, game.unit, 1.0]
    inside = np.hypot(poses[:, 0], poses[:, 1]) <= table.grid.edge
    poses, pieces = poses[inside], np.abs(pieces[inside])
    found = table.value(poses)
    values = np.abs(found - capture)
    apart = np.abs(barrier_offsets(table, poses, capture))
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
                "pose": poses[i].tolist(),
                "analytic_m": capture,
                "table_m": float(found[i]),
            }
            for i in picks.astype(int)
        ],
    }


def describe_refinement(tables: "Sequence[ValueTable]") -> dict[str, Any]:
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


def played_games(
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
