"""What the unicycles' game gives from many starts."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]


def certified_starts(result: Result) -> str:
    """Shares of random starts in the diamond and with a certified bound."""
    head = ("starts", "diamond", "certified, kept", "certified, behind")
    keys = ("in the diamond", "certain, latched", "certain, behind")
    rows = [
        (row["starts"], *(_percent(row[key]) for key in keys))
        for row in result["rows"]
    ]
    return table(head, rows)


def remedies(result: Result) -> str:
    """What an evader can do about a close reversed circle."""
    head = (
        "remedy",
        "end reversed",
        "captured",
        "mean closest [m]",
        "least at the end [m]",
    )
    rows = [
        (
            row["name"],
            _percent(row["reversed_share"]),
            _percent(row["captured_share"]),
            number(row["mean_closest_distance_m"], 2),
            number(row["end_distance_m"], 2),
        )
        for row in result["rows"]
    ]
    return table(head, rows)


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"
