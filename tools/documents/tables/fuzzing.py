"""Counts of fuzz cases and failures, by class."""

from collections.abc import Mapping
from typing import Any

from .markdown import table

HEAD = ("tried", "tracebacks", "hangs", "nonsense", "leftovers", "other")


def classes(result: Mapping[str, Any]) -> str:
    """List the number of cases and failures of each class."""
    rows = [*result["classes"].items(), ("**all**", result["total"])]
    return table(
        ("class", *HEAD),
        [(name, *(str(row[column]) for column in HEAD)) for name, row in rows],
    )
