"""Compare evaders with the optimal one of both relative games.

Lengths are in units of speed over gain. Every evader starts from the same
states as the optimal one::

    python tools/benchmarks/bound_value.py
"""

from itertools import pairwise
from math import pi, tau
from typing import Any

import numpy as np
from benchmark_options import ask, machine
from numpy.typing import NDArray
from result_files import header, write_result

from stepaside.core.poses import arc, rotate
from stepaside.theory.unicycle import Unicycles, play_games
from stepaside.theory.value import (
    CarGame,
    ValueTable,
    solve_cars,
)
from stepaside.theory.value.two_cars import barrier_poses, car_poses

Array = NDArray[np.float64]
LAW = CarGame(1.0, 1.0, pursuer_gain=1.0)
CARS = CarGame(1.0, 1.0, pursuer_turn=1.0)
GAMES = 4000
DURATION = tau
PARTS = 8  # of a decision of the optimal evader, in which the law decides
# distance range [v/k], maximum bearings of evader and pursuer
BOXES = {
    "all starts from 0.3 to 3 v/k": (0.3, 3.0, pi, pi),
    "starts of a duel": (1.2, 3.0, pi / 2, pi / 6),
}
EVADERS = {
    "move back": (0.0, "proportional"),
    "22.5°": (pi / 8, "proportional"),
    "45°": (pi / 4, "proportional"),
    "move aside": (pi / 2, "proportional"),
    "saturated": (pi / 2, "saturated"),
}


def starts_in(box: tuple[float, float, float, float]) -> Array:
    """Draw random initial r, a, psi from a box. Shape (n, 3)."""
    rng = np.random.default_rng(13)
    near, far, aim, facing = box
    low, high = [near, -aim, -facing], [far, aim, facing]
    return rng.uniform(low, high, (GAMES, 3))


def play_optimal(table: ValueTable, poses: Array) -> Array:
    """Return closest approaches of the evader of a table."""
    step = LAW.period(table.grid.spacing) / PARTS
    least: Array = np.hypot(poses[:, 0], poses[:, 1])
    for n in range(round(DURATION / step)):
        if n % PARTS == 0:
            chosen = LAW.evader_twists[table.best_motion(poses)]
        aim = np.arctan2(poses[:, 1], poses[:, 0]) * (1.0 - np.exp(-step))
        own, other = arc(*(step * chosen.T)), arc(step, 0.0 * aim, aim)
        x, y = rotate(own[:, 0], own[:, 1], poses[:, 2])
        x, y = poses[:, 0] + x - other[:, 0], poses[:, 1] + y - other[:, 1]
        turned = poses[:, 2] + own[:, 2] - aim
        poses = np.column_stack([*rotate(x, y, -aim), turned])
        least = np.minimum(least, np.hypot(x, y))
    return least


def compare(table: ValueTable, starts: Array) -> list[dict[str, Any]]:
    """Return the mean closest approach of every evader and of the table."""
    poses = car_poses(*starts.T)
    played = {"optimal": play_optimal(table, poses)}
    for name, (angle, law) in EVADERS.items():
        game = Unicycles(1.0, 1.0, 1.0, 1.0, angle, law)
        played[name] = play_games(game, starts, DURATION).closest_distance
    bound, best = table.value(poses), played["optimal"].mean()
    return [
        {
            "evader": name,
            "closest": float(closest.mean()),
            "over_bound": float(closest.mean() / bound.mean()),
            "best_over_this": float(best / closest.mean()),
            "most_above": float(max((closest - bound).max(), 0.0)),
        }
        for name, closest in played.items()
    ]


def solved(game: CarGame, far: float, cells: int) -> tuple[ValueTable, Any]:
    """Return the finest table, and the differences of coarser ones."""
    tables = [solve_cars(game, far, cells // n) for n in (4, 2, 1)]
    rows = []
    for coarse, fine in pairwise(tables):
        off = fine.differences(coarse)
        count = coarse.grid.rows - 1
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
        apart = np.abs(cars.offsets(poses, capture))
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
