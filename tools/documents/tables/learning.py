"""Ratings of strategies, and steps per second of environments."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]


def rating(result: Result) -> str:
    """List every strategy in every world, a column for each opponent.

    A cell holds the mean closest approach in [m] and the share of games that
    were survived.
    """
    rows = result["rows"]
    opponents = list(dict.fromkeys(row["opponent"] for row in rows))
    cells: dict[tuple[str, str], dict[str, Any]] = {}
    for row in rows:
        place = (row["strategy"], row["world"])
        cells.setdefault(place, {})[row["opponent"]] = row
    head = ("strategy", "world", *opponents, "regret [m]", "of the bound")
    lines = []
    for (strategy, world), found in cells.items():
        bounded = next(
            (r for r in found.values() if r["mean_ratio"] is not None), None
        )
        lines.append(
            (
                f"`{strategy}`",
                world,
                *(_closest(found[name]) for name in opponents),
                *_of_the_bound(bounded),
            )
        )
    return table(head, lines)


def _closest(row: Mapping[str, Any]) -> str:
    """Return mean closest approach and survival of a row."""
    return f"{row['mean_closest_m']:.2f} ({100 * row['survived']:.0f} %)"


def _of_the_bound(row: Mapping[str, Any] | None) -> tuple[str, str]:
    """Return mean regret and mean share of the bound; empty without one."""
    if row is None:
        return "", ""
    return (
        f"{row['mean_regret_m']:.3f} ± {row['mean_regret_pm_m']:.3f}",
        f"{row['mean_ratio']:.3f} ± {row['mean_ratio_pm']:.3f}",
    )


def scores(result: Result) -> str:
    """List the score of each strategy."""
    head = (
        *("strategy", "role", "score [m]", "mean regret [m]"),
        "survived against the suite",
    )
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
