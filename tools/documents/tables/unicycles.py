"""Games of unicycles from many initial poses."""

from collections.abc import Mapping
from typing import Any

from .markdown import NONE, table

Result = Mapping[str, Any]


def certified_starts(result: Result) -> str:
    """List fractions of starts in the diamond and with a certificate."""
    head = ("starts", "diamond", "certified, kept", "certified, behind")
    keys = ("in the diamond", "certain, latched", "certain, behind")
    rows = [
        (row["starts"], *(_percent(row[key]) for key in keys))
        for row in result["rows"]
    ]
    return table(head, rows)


def side_changes(result: Result) -> str:
    """List outcomes and closest approaches of games of unequal players."""
    head = (
        "law",
        "pursuer",
        "stable circle",
        "starts",
        "settle",
        "change sides",
        "part, or captured",
        "other",
        "nearer than 0.1 v/k",
    )
    rows = [
        (
            "(4)" if row["law"] == "proportional" else "(6)",
            row["pursuer"],
            "yes" if row["stable_circle"] else "no",
            str(row["starts"]),
            str(row["settled"]),
            str(row["changes_sides"]),
            str(row["escaped"] + row["captured"]),
            str(row["other"]),
            f"{row['near']} of {row['changes_sides']}"
            if row["changes_sides"]
            else NONE,
        )
        for row in result["rows"]
    ]
    return table(head, rows)


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"
