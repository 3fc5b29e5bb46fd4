"""Compare evaders with the optimal one of both relative games.

Lengths are in units of speed over gain. Every evader starts from the same
states as the optimal one::

    python tools/benchmarks/bound_value.py
"""

from itertools import pairwise
from math import pi
from typing import Any

import numpy as np
from benchmark_options import ask, machine
from numpy.typing import NDArray
from result_files import header, write_result

from stepaside.core.poses import wrap_angles
from stepaside.theory.value import (
    CarGame,
    ValueTable,
    solve_cars,
)
from stepaside.theory.value.checks import (
    Evader,
    barrier_offsets,
    compare_evaders,
    differences,
    driven,
    fixed_angle_evader,
)
from stepaside.theory.value.closed_forms import barrier_poses
from stepaside.theory.value.two_cars import car_poses

Array = NDArray[np.float64]
LAW = CarGame(1.0, 1.0, pursuer_gain=1.0)
CARS = CarGame(1.0, 1.0, pursuer_turn=1.0)
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


def saturated(poses: Array) -> Array:
    """Return the evader of eq. (6) with a gain of one."""
    sight = np.arctan2(poses[:, 1], poses[:, 0])
    psi = wrap_angles(sight - poses[:, 2])
    side = np.where(psi < 0.0, 1.0, -1.0)
    return driven(LAW, np.sign(psi + side * pi / 2))


def starts_in(box: tuple[float, float, float, float]) -> Array:
    """Draw random initial poses from a box of (r, a, psi). Shape (n, 3)."""
    rng = np.random.default_rng(13)
    near, far, aim, facing = box
    low, high = [near, -aim, -facing], [far, aim, facing]
    return car_poses(*rng.uniform(low, high, (GAMES, 3)).T)


def compare(table: ValueTable, starts: Array) -> list[dict[str, Any]]:
    """Return the mean closest approach of every evader and of the table."""
    evaders: dict[str, Evader | None] = {"optimal": None}
    evaders |= {
        name: fixed_angle_evader(LAW, angle) for name, angle in ANGLES.items()
    }
    evaders["saturated"] = saturated
    rows = compare_evaders(LAW, table, evaders, starts)
    return [
        {
            "evader": row["name"],
            "closest": row["closest"],
            "over_bound": row["over_bound"],
            "best_over_this": rows[0]["closest"] / row["closest"],
            "most_above": row["above"],
            "most_off": row["most"],
        }
        for row in rows
    ]


def solved(game: CarGame, far: float, cells: int) -> tuple[ValueTable, Any]:
    """Return the finest table, and the differences of coarser ones."""
    tables = [solve_cars(game, far, cells // n) for n in (4, 2, 1)]
    rows = []
    for coarse, fine in pairwise(tables):
        off = differences(coarse, fine)
        count = coarse.grid.shape[1] - 1
        rows.append(
            {
                "cells": count,
                "finer": 2 * count,
                "seconds": coarse.seconds,
                "mean": float(off.mean()),
                "most": float(np.quantile(off, 0.95)),
                "worst": float(off.max()),
                "above_mean": float((off > off.mean()).mean()),
            }
        )
    table = tables[-1]
    return table, {
        "seconds": table.seconds,
        "falling": table.change,
        "refinement": rows,
    }


def main() -> None:
    """Solve both games, simulate, and write the results."""
    asked = ask(__doc__, "bound.json")
    asked.add_argument("--cells", type=int, default=64)
    arguments = asked.parse_args()
    cells = arguments.cells

    pursuit, law = solved(LAW, 4.5, cells)
    boxes = {name: compare(pursuit, starts_in(b)) for name, b in BOXES.items()}
    found: dict[str, Any] = {"pursuit": law | {"boxes": boxes}}
    cars, free = solved(CARS, 8.0, cells)
    barrier = []
    for capture in (0.5, 1.0, 2.0, 3.0):
        poses, _ = barrier_poses(capture)
        off = np.abs(cars.value(poses) - capture)
        apart = np.abs(barrier_offsets(cars, poses, capture))
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
    found["cars"] = free | {"barrier": barrier}
    head = header({"cells": cells, "games": GAMES})
    write_result(arguments.output, head, machine=machine(), **found)
    for name, table in boxes.items():
        print(name, *table, sep="\n")
    print(*found["cars"]["refinement"], *barrier, sep="\n")


if __name__ == "__main__":
    main()
