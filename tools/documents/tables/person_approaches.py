"""People walking towards the evader."""

from collections.abc import Mapping
from typing import Any

from .markdown import interval, table

WALKS = {
    "steers-slowly": "steers, 0.073 m/s, 0.146 1/s",
    "steers": "steers, 0.15 m/s, 0.2 1/s",
    "straight": "straight at it, 0.15 m/s",
    "past": "straight past at 1.2 m, 0.15 m/s",
}
FIGURES = {
    "triggered_at_distance_m": "triggered at [m]",
    "min_distance_m": "closest [m]",
    "theory_closest_m": "theory [m]",
}


def ranges(result: Mapping[str, Any]) -> str:
    """List each path with the range over its seeds."""
    rows = []
    for walk, found in result["walks"].items():
        spreads = [found[key] for key in FIGURES]
        rows.append(
            (
                WALKS[walk],
                str(found["number"]),
                str(found["contacts"]),
                str(found["falls"]),
                *(interval(s["least"], s["greatest"], 2) for s in spreads),
            )
        )
    return table(("walk", "duels", "touched", "fell", *FIGURES.values()), rows)
