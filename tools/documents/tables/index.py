"""Index of all results."""

from collections.abc import Mapping
from typing import Any

from .markdown import table


def index(results: Mapping[str, Mapping[str, Any]]) -> str:
    """List each result with its command, code and libraries."""
    rows = []
    for name, result in results.items():
        libraries = ", ".join(
            f"{library} {version or 'none'}"
            for library, version in result["libraries"].items()
        )
        rows.append(
            (
                f"[{name}]({name}.json)",
                f"`{result['command']}`",
                result["version"],
                libraries,
            )
        )
    return table(("result", "made by", "code", "libraries"), rows)
