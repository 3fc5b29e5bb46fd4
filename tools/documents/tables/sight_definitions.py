"""Definitions of heading and point of the line of sight."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

HEAD = (
    "heading subtracted",
    "point sighted",
    "duels",
    "pursuer radius [m]",
    "evader radius [m]",
    "distance of the places [m]",
    "of the torsos [m]",
)
HEADINGS = {"path": "path, where the body is"}


def sight_definitions(result: Mapping[str, Any]) -> str:
    """List means over the seeds for each combination."""
    groups: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for row in result["rows"]:
        groups.setdefault((row["heading"], row["point"]), []).append(row)
    lines = []
    for (heading, point), rows in groups.items():
        lines.append(
            (
                HEADINGS.get(heading, heading),
                point,
                str(len(rows)),
                number(_mean(rows, "pursuer_radius_m")),
                number(_mean(rows, "evader_radius_m")),
                number(_mean(rows, "distance_m")),
                number(_mean(rows, "torsos_apart_m")),
            )
        )
    return table(HEAD, lines)


def _mean(rows: list[Mapping[str, Any]], key: str) -> float:
    return float(sum(row[key] for row in rows) / len(rows))
