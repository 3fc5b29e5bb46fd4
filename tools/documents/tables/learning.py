"""Ratings of strategies, and steps per second of environments."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]


def rating(result: Result) -> str:
    """List every strategy in every world against every opponent."""
    head = (
        "strategy",
        "world",
        "opponent",
        "games",
        "survived",
        "95 %",
        "closest [m]",
        "regret [m]",
        "of the bound",
    )
    return table(head, [_rated(row) for row in result["rows"]])


def _rated(row: Mapping[str, Any]) -> tuple[str, ...]:
    """Return one line of a rating."""
    low, high = row["survived_low"], row["survived_high"]
    return (
        f"`{row['strategy']}`",
        row["world"],
        row["opponent"],
        str(row["games"]),
        f"{100 * row['survived']:.0f} %",
        f"{100 * low:.0f}-{100 * high:.0f}",
        _with_interval(row, "mean_closest"),
        _with_interval(row, "mean_regret"),
        ""
        if row["mean_ratio"] is None
        else f"{row['mean_ratio']:.3f} ± {row['mean_ratio_pm']:.3f}",
    )


def _with_interval(row: Mapping[str, Any], name: str) -> str:
    """Return a mean in [m] with half its interval; empty without one."""
    value, half = row[f"{name}_m"], row[f"{name}_pm_m"]
    return "" if value is None else f"{value:.3f} ± {half:.3f}"


def scores(result: Result) -> str:
    """List the score of each strategy."""
    head = "strategy", "role", "score [m]", "mean regret [m]", "survived"
    rows = [
        (
            f"`{row['strategy']}`",
            row["role"],
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
        "kernel_steps_per_s": "the bare kernel on the same games",
        "parallel_steps_per_s": "`duel_v0.parallel_env`, one game",
        "mpe2_steps_per_s": "`simple_tag_v3` of MPE2, one game",
    }
    rows = [
        (text, f"{result['figures'][name]:,.0f}")
        for name, text in names.items()
        if name in result["figures"]
    ]
    return table(("environment", "steps per second"), rows)
