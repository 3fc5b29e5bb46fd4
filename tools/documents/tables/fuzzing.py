"""Bad input that was tried, by class, and what was wrong with it."""

from collections.abc import Mapping
from typing import Any

from .markdown import table

HEAD = ("tried", "tracebacks", "hangs", "nonsense", "leftovers", "other")


def classes(result: Mapping[str, Any]) -> str:
    """How many cases of each class, and how many were wrong in which way."""
    rows = [*result["classes"].items(), ("**all**", result["total"])]
    return table(
        ("class", *HEAD),
        [(name, *(str(row[column]) for column in HEAD)) for name, row in rows],
    )
