"""Compare the grid of the chauffeur's game with its closed forms.

Lengths are in turning radii, speeds in those of the pursuer::

    python tools/benchmarks/chauffeur.py
"""

from typing import Any

import numpy as np
from benchmark_options import ask, machine
from result_files import header, write_result

from stepaside.theory.value import (
    ChauffeurGame,
    solve_chauffeur,
)

RATIOS = (0.2, 0.36, 0.5, 0.643, 0.8, 0.95)
CELLS = (30, 60, 120)
SHARE = 0.7  # capture distance of the barrier, of the guaranteed one


def row_of(ratio: float) -> dict[str, Any]:
    """Return the values of one speed ratio."""
    game = ChauffeurGame(1.0, ratio, 1.0)
    closed = game.guaranteed_distance
    row: dict[str, Any] = {"ratio": ratio, "closed": closed, "grids": []}
    for cells in CELLS:
        table = solve_chauffeur(game, cells)
        row["grids"].append(
            {
                "cells": cells,
                "guaranteed": table.grid.outside,
                "error": table.grid.outside / closed - 1.0,
                "seconds": table.seconds,
            }
        )
    row["barrier"] = None  # without closed form in the second regime
    poses = game.barrier(SHARE * closed)
    if poses is not None:
        off = np.abs(table.offsets(poses, SHARE * closed))
        off /= table.grid.spacing
        row["barrier"] = {
            "mean_cells": float(off.mean()),
            "worst_cells": float(off.max()),
        }
    return row


def main() -> None:
    """Solve, compare, and write the results."""
    arguments = ask(__doc__, "chauffeur.json").parse_args()
    rows = [row_of(ratio) for ratio in RATIOS]
    head = header({"cells": list(CELLS), "capture_share": SHARE})
    write_result(arguments.output, head, machine=machine(), rows=rows)
    print(*rows, sep="\n")


if __name__ == "__main__":
    main()
