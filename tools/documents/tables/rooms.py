"""Duels among obstacles."""

from collections.abc import Mapping
from typing import Any

from .markdown import counted, interval, number, table

MAPS = {"given": "given", "seen": "seen by cameras", "none": "none"}


def outcomes(result: Mapping[str, Any]) -> str:
    """List the results of the duels of each strategy."""
    return table(
        (
            "evader",
            "pursuer",
            "map",
            "duels",
            "nothing touched",
            "captured",
            "contact",
            "touched the room",
            "fell",
            "time played [s]",
            "closest [m]",
            "clearance [m]",
        ),
        [
            (
                row["strategy"],
                row["pursuer"],
                MAPS[row["map"]],
                str(row["duels"]),
                counted(row["untouched"], row["duels"]),
                counted(row["captured"], row["duels"]),
                counted(row["contact"], row["duels"]),
                counted(row["touched_room"], row["duels"]),
                counted(row["fell"], row["duels"]),
                number(row["survived_s"]["mean"], 0),
                interval(
                    row["closest_m"]["least"], row["closest_m"]["greatest"], 2
                ),
                number(row["clearance_m"]["least"], 3),
            )
            for row in result["summary"]
        ],
    )
