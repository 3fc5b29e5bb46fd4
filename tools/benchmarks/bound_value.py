"""Compare evaders with the optimal one of both relative games.

Lengths are in units of speed over gain. Every evader starts from the same
states as the optimal one::

    python tools/benchmarks/bound_value.py
"""

from dataclasses import asdict
from math import pi
from typing import Any

import numpy as np
from benchmark_options import ask, machine
from numpy.typing import NDArray

from stepaside.studies.result_files import header, write_result
from stepaside.theory.bound import (
    Bound,
    Grid,
    fixed_pursuit_game,
    two_car_game,
)
from stepaside.theory.bound.bound_checks import (
    Steering,
    check_barrier,
    fixed_angle_evader,
    play_bound,
)
from stepaside.theory.bound.grid_refinement import refine_bound

Array = NDArray[np.float64]
MODULES = ("theory/bound", "theory/unicycle")
LIBRARIES = ("numpy", "numba")
GAMES = 4000
# distance range [v/k], maximum bearings of evader and pursuer
BOXES = {
    "all starts from 0.3 to 3 v/k": (0.3, 3.0, pi, pi),
    "starts of a duel": (1.2, 3.0, pi / 2, pi / 6),
}
ANGLES = {
    "move back": 0.0,
    "22.5°": pi / 8,
    "45°": pi / 4,
    "move aside": pi / 2,
}


def saturated(r: Array, a: Array, psi: Array) -> Array:
    """Return the evader of eq. (6) with a gain of one."""
    side = np.where(psi < 0.0, 1.0, -1.0)
    turn: Array = np.sign(psi + side * pi / 2)
    return turn


def starts_in(box: tuple[float, float, float, float]) -> Array:
    """Draw random initial states (r, a, psi) from a box. Shape (n, 3)."""
    rng = np.random.default_rng(13)
    near, far, aim, facing = box
    low, high = [near, -aim, -facing], [far, aim, facing]
    return rng.uniform(low, high, (GAMES, 3))


def compare(bound: Bound, starts: Array) -> list[dict[str, Any]]:
    """Return the mean closest approach of every evader and of the table."""
    evaders: dict[str, Steering | None] = {"optimal": None}
    evaders |= {
        name: fixed_angle_evader(bound, angle)
        for name, angle in ANGLES.items()
    }
    evaders["saturated"] = saturated
    promised = bound.value(*starts.T)
    rows: list[dict[str, Any]] = []
    for name, evader in evaders.items():
        kept = play_bound(bound, starts, evader)
        best = rows[0]["closest"] if rows else float(kept.mean())
        rows.append(
            {
                "evader": name,
                "closest": float(kept.mean()),
                "bound": float(promised.mean()),
                "over_bound": float(kept.mean() / promised.mean()),
                "best_over_this": best / float(kept.mean()),
                "most_above": float(np.max(kept - promised)),
                "share_above": float((kept - promised > 0.01).mean()),
                "most_off": float(np.quantile(np.abs(kept - promised), 0.95)),
            }
        )
    return rows


def refinement(rows: Any) -> list[dict[str, Any]]:
    """Return the differences between grids and finer ones."""
    return [
        {
            "cells": row.grid.distances - 1,
            "finer": 2 * (row.grid.distances - 1),
            **{k: v for k, v in asdict(row).items() if k != "grid"},
        }
        for row in rows
    ]


def main() -> None:
    """Solve both games, simulate, and write the results."""
    asked = ask(__doc__, "bound.json")
    asked.add_argument("--cells", type=int, default=96)
    arguments = asked.parse_args()
    cells = arguments.cells

    law = fixed_pursuit_game(1.0, 1.0, 1.0)
    pursuit, rows = refine_bound(law, Grid.cube(0.15, 4.5, cells), 2)
    boxes = {name: compare(pursuit, starts_in(b)) for name, b in BOXES.items()}
    found: dict[str, Any] = {
        "pursuit": {
            "seconds": pursuit.seconds,
            "horizon": pursuit.horizon,
            "falling_mean": pursuit.falling_mean,
            "falling_worst": pursuit.falling_worst,
            "refinement": refinement(rows),
            "boxes": boxes,
        }
    }
    free = two_car_game(1.0, 1.0, 1.0)
    cars, rows = refine_bound(free, Grid.cube(0.3, 8.0, cells), 2)
    barrier = []
    for capture in (0.5, 1.0, 2.0, 3.0):
        check = check_barrier(cars, capture)
        off, apart = np.abs(check.value_errors), np.abs(check.distance_errors)
        barrier.append(
            {
                "capture": capture,
                "points": len(off),
                "median": float(np.median(off)),
                "mean": float(off.mean()),
                "worst": float(off.max()),
                "apart_median": float(np.median(apart)),
                "apart_mean": float(apart.mean()),
            }
        )
    found["cars"] = {
        "seconds": cars.seconds,
        "horizon": cars.horizon,
        "falling_mean": cars.falling_mean,
        "falling_worst": cars.falling_worst,
        "refinement": refinement(rows),
        "barrier": barrier,
    }
    head = header({"cells": cells, "games": GAMES})
    write_result(arguments.output, head, machine=machine(), **found)
    for name, table in boxes.items():
        print(name, *table, sep="\n")
    print(*found["cars"]["refinement"], *barrier, sep="\n")


if __name__ == "__main__":
    main()
