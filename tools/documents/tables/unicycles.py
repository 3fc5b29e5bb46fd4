"""Games of unicycles from many initial poses."""

from collections.abc import Mapping
from typing import Any

from .markdown import table

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


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"
