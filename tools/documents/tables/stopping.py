"""Commands interrupted by Ctrl-C."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table


def stops(result: Mapping[str, Any]) -> str:
    """List how much each command still worked, at worst, and how it ended."""
    return table(
        (
            "command",
            "processor time to end, at most [s]",
            "time to end, at most [s]",
            "statuses",
            "last line",
        ),
        (_row(row["command"], row["stops"]) for row in result["rows"]),
    )


def _row(command: str, stopped: list[Mapping[str, Any]]) -> tuple[str, ...]:
    statuses = sorted({stop["status"] for stop in stopped})
    return (
        f"`{command}`",
        number(max(stop["worked_s"] for stop in stopped), 1),
        number(max(stop["ended_s"] for stop in stopped), 1),
        ", ".join(map(str, statuses)),
        stopped[-1]["said"],
    )
