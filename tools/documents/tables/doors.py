"""One duel at every level from every door."""

from collections.abc import Mapping
from typing import Any

from .markdown import table

Result = Mapping[str, Any]


def doors(result: Result) -> str:
    """List how one duel goes on at each level from each door."""
    cells: dict[str, dict[str, str]] = {}
    for row in result["rows"]:
        own, door = cells.setdefault(row["level"], {}), row["door"]
        if row["room"]:
            own[door] += f"; `{row['outcome']}` {row['time_s']:.2f}"
        else:
            own[door] = f"{row['closest_m']:.3f}, {row['distance_m']:.3f}"
    doors = list(next(iter(cells.values())))
    rows = [
        (f"`{level}`", *(own.get(door, "") for door in doors))
        for level, own in cells.items()
    ]
    return table(("level", *doors), rows)
