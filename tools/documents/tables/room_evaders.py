"""Survival by pursuer, evader and floor."""

from collections.abc import Mapping
from typing import Any

from .markdown import NONE, interval, number, table

Result = Mapping[str, Any]


def survivals(*results: Result) -> str:
    """List survival against each pursuer, with the paper's circle."""
    cells: dict[str, dict[str, str]] = {}
    circles: dict[str, str] = {}
    for row in (row for result in results for row in result["rows"]):
        pursuer, found = row["pursuer"], row["survived"]
        column = f"{row['evader']}, {row['floor']} (n = {row['number']})"
        ends = interval(100 * found["low"], 100 * found["high"], 0)
        text = f"{100 * found['share']:.0f} % ({ends})"
        cells.setdefault(pursuer, {})[column] = text
        circle = row["circle_m"]
        circles[pursuer] = number(circle and circle["mean"], 3)
    columns = dict.fromkeys(name for own in cells.values() for name in own)
    rows = [
        (pursuer, circles[pursuer], *(own.get(c, NONE) for c in columns))
        for pursuer, own in cells.items()
    ]
    return table(("pursuer", "circle [m]", *columns), rows)
