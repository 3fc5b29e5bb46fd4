"""Compare the grid of the chauffeur's game with its closed forms.

Lengths are in turning radii, speeds in those of the pursuer::

    python tools/benchmarks/chauffeur.py
"""

from typing import Any

import numpy as np
from benchmark_options import ask, machine

from stepaside.core.errors import PlanError
from stepaside.studies.result_files import header, write_result
from stepaside.theory.chauffeur import (
    ChauffeurGame,
    SpeedEllipse,
    solve_chauffeur,
)
from stepaside.theory.chauffeur.chauffeur_checks import (
    check_chauffeur_barrier,
    play_chauffeur,
)

MODULES = ("theory/chauffeur",)
LIBRARIES = ("numpy", "numba")
RATIOS = (0.2, 0.36, 0.5, 0.643, 0.8, 0.95)
CELLS = (30, 60, 120)
SHARE = 0.7  # capture distance of the barrier, of the guaranteed one
GAMES = 200
DURATION = 8.0  # of a game, in turning radii per pursuer speed


def row_of(ratio: float) -> dict[str, Any]:
    """Return the values of one speed ratio."""
    game = ChauffeurGame(1.0, 1.0, SpeedEllipse.disc(ratio))
    closed = game.guaranteed_distance
    assert closed is not None
    row: dict[str, Any] = {"ratio": ratio, "closed": closed, "grids": []}
    for cells in CELLS:
        table = solve_chauffeur(game, cells)
        row["grids"].append(
            {
                "cells": cells,
                "guaranteed": table.guaranteed,
                "error": table.guaranteed / closed - 1.0,
                "seconds": table.seconds,
            }
        )
    row["barrier"] = None
    try:
        found = check_chauffeur_barrier(table, SHARE * closed)
    except PlanError:
        pass  # no closed form in the second regime
    else:
        off = np.abs(found.errors) / found.spacing
        row["barrier"] = {
            "mean_cells": float(off.mean()),
            "worst_cells": float(off.max()),
        }
    starts = np.random.default_rng(17).uniform(
        [-ratio, -1.5 * ratio], [2.0 * ratio, 1.5 * ratio], (GAMES, 2)
    )
    expected = table.value(*starts.T)
    row["played"] = {
        pursuer: float(
            (
                play_chauffeur(
                    table, starts, duration=DURATION, pursuer=pursuer
                )
                - expected
            ).min()
            / closed
        )
        for pursuer in ("optimal", "direct")
    }
    return row


def main() -> None:
    """Solve, compare, simulate, and write the results."""
    arguments = ask(__doc__, "chauffeur.json").parse_args()
    rows = [row_of(ratio) for ratio in RATIOS]
    head = header(
        {"cells": list(CELLS), "games": GAMES, "capture_share": SHARE}
    )
    write_result(arguments.output, head, machine=machine(), rows=rows)
    print(*rows, sep="\n")


if __name__ == "__main__":
    main()
