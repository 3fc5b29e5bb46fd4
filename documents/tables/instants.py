"""Which heading and which point the line of sight refers to."""

from collections.abc import Mapping
from typing import Any

from .markdown import interval, number, table

HEAD = (
    "heading subtracted",
    "point sighted",
    "duels",
    "pursuer radius [m]",
    "evader radius [m]",
    "distance [m]",
    "least to greatest distance [m]",
)


def instants(result: Mapping[str, Any]) -> str:
    """Means over the seeds for each pair of choices."""
    groups: dict[tuple[str, float], list[Mapping[str, Any]]] = {}
    for row in result["rows"]:
        groups.setdefault((row["heading"], row["behind_m"]), []).append(row)
    lines = []
    for (heading, behind), rows in groups.items():
        away = [row["distance_m"] for row in rows]
        lines.append(
            (
                heading,
                f"{1000.0 * behind:.0f} mm behind the torso"
                if behind
                else "torso",
                str(len(rows)),
                number(_mean(rows, "pursuer_radius_m")),
                number(_mean(rows, "evader_radius_m")),
                number(_mean(rows, "distance_m")),
                interval(min(away), max(away)),
            )
        )
    return table(HEAD, lines)


def _mean(rows: list[Mapping[str, Any]], key: str) -> float:
    return float(sum(row[key] for row in rows) / len(rows))
