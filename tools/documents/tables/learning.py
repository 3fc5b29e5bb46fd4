"""Ratings of strategies, and steps per second of environments."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]


def scores(result: Result) -> str:
    """List the score of each strategy."""
    head = (
        *("strategy", "score [m]", "mean regret [m]"),
        "survived against the suite",
    )
    rows = [
        (
            f"`{row['strategy']}`",
            f"{row['score_m']:.3f} ± {row['score_pm_m']:.3f}",
            ""
            if row["mean_regret_m"] is None
            else number(row["mean_regret_m"], 3),
            f"{100 * row['survived']:.0f} %",
        )
        for row in result["scores"]
    ]
    return table(head, rows)


def environments(result: Result) -> str:
    """List steps per second of each environment."""
    names = {
        "vector_steps_per_s": "vector environment, 4096 games",
        "parallel_steps_per_s": "`ParallelDuel`, one game",
        "mpe2_steps_per_s": "`simple_tag_v3` of MPE2, one game",
    }
    rows = [
        (text, f"{result['figures'][name]:,.0f}")
        for name, text in names.items()
        if name in result["figures"]
    ]
    return table(("environment", "steps per second"), rows)
