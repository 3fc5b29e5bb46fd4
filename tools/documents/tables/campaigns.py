"""Cost of campaigns: core-hours by kind of duel, and the parent process."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]
BODIES = {
    "ideal": "ideal",
    "hardware": "hardware-like",
    "cameras": "ideal, with cameras",
}


def costs(result: Result) -> str:
    """List core-hours per thousand duels and the memory of a worker."""
    head = (
        *("body", "core-hours per thousand duels of 120 s"),
        *("core-hours per million", "memory of a worker [MiB]"),
    )
    return table(
        head,
        [
            (
                BODIES[row["kind"]],
                number(row["core_hours_per_thousand"], 1),
                number(1e3 * row["core_hours_per_thousand"], 0),
                number(row["memory_mib"], 0),
            )
            for row in result["kinds"]
        ],
    )


def parents(result: Result) -> str:
    """List what the parent needs for trivial cases, by executor."""
    head = (
        *("executor", "cases", "processor time per case [us]"),
        *("peak memory of the parent [MiB]", "wall time [s]"),
    )
    return table(
        head,
        [
            (
                f"`{row['executor']}`",
                f"{row['cases']:,}",
                number(row["parent_us_per_case"], 0),
                number(row["parent_memory_mib"], 0),
                number(row["wall_s"], 0),
            )
            for row in result["parents"]
        ],
    )
