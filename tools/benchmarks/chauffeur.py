"""Compare the grid of the chauffeur's game with its closed forms.

Lengths are in turning radii, speeds in those of the pursuer::

    python tools/benchmarks/chauffeur.py
"""

from typing import Any

import numpy as np
from benchmark_options import ask, machine
from result_files import header, write_result

from stepaside.core.errors import PlanError
from stepaside.core.poses import Array
from stepaside.theory.value import (
    ChauffeurGame,
    SpeedEllipse,
    ValueTable,
    solve_chauffeur,
)
from stepaside.theory.value.chauffeur import barrier_of
from stepaside.theory.value.checks import barrier_offsets, play

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
                "guaranteed": table.rules.outside,
                "error": table.rules.outside / closed - 1.0,
                "seconds": table.seconds,
            }
        )
    row["barrier"] = None
    try:
        poses = barrier_of(game, SHARE * closed)
    except PlanError:
        pass  # no closed form in the second regime
    else:
        off = np.abs(barrier_offsets(table, poses, SHARE * closed))
        off /= table.grid.spacing
        row["barrier"] = {
            "mean_cells": float(off.mean()),
            "worst_cells": float(off.max()),
        }
    row["played"] = {
        pursuer: float(played(game, table, pursuer).min() / closed)
        for pursuer in ("optimal", "direct")
    }
    return row


def played(game: ChauffeurGame, table: ValueTable, pursuer: str) -> Array:
    """Return closest approaches of the table's evader less its values.

    The pursuer answers as the table does, or turns straight at the evader
    within a period.
    """
    ratio, direct = game.ratio, pursuer == "direct"
    starts = np.random.default_rng(17).uniform(
        [-ratio, -1.5 * ratio, 0.0], [2.0 * ratio, 1.5 * ratio, 0.0],
        (GAMES, 3),
    )  # fmt: skip

    def answer(poses: Array, chosen: Array) -> Array:
        if not direct:
            turns: Array = game.turns[table.decisions(poses)[:, 1]]
            return turns
        aim = np.arctan2(poses[:, 1], poses[:, 0])
        turn = np.clip(8.0 * aim / game.period, -1.0, 1.0)
        return np.column_stack([np.ones_like(aim), 0.0 * aim, turn])

    closest = play(
        starts,
        lambda poses: game.twists[table.best_motion(poses)],
        answer,
        period=game.period,
        duration=DURATION,
        faces=True,
        reacts=direct,
    )
    found: Array = closest - table.value(starts)
    return found


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
