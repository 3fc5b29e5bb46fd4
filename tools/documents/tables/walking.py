"""Walks of one robot."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table


def fast_walks(result: Mapping[str, Any]) -> str:
    """List falls, speed and turning with the fast gait, by body."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    straight: dict[str, list[float]] = {}
    for name, found in result["walks"].items():
        body, way, bearing, _ = name.split("/")
        groups.setdefault(f"{body}, {way}", []).append(found)
        if bearing == "0" and found["speed_m_s"] is not None:
            straight.setdefault(f"{body}, {way}", []).append(
                found["speed_m_s"]
            )

    def spread(values: list[float]) -> str:
        ends = {number(value, 3) for value in (min(values), max(values))}
        return "-".join(sorted(ends))

    def ratios(found: list[Mapping[str, Any]], key: str) -> str:
        return spread([row[key] for row in found if row[key] is not None])

    return table(
        (
            "walks of the fast gait",
            "number",
            "falls",
            "speed, straight on [m/s]",
            "speed / planned",
            "turning / planned",
        ),
        [
            (
                words,
                str(len(found)),
                str(sum(row["outcome"] != "completed" for row in found)),
                spread(straight[words]),
                ratios(found, "speed_ratio"),
                ratios(found, "yaw_ratio"),
            )
            for words, found in groups.items()
        ],
    )
