"""Who survives in which room, how near, on how much floor."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]


def worlds(result: Result) -> str:
    """Every evader in every world, by the paper's pursuer."""
    head = (
        "world",
        "evader",
        "survives",
        "95 %",
        "touches",
        "is caught",
        "closest [m]",
        "of the bound",
        "floor used [m²]",
        "turning [rad/s]",
        "decision [ms]",
    )
    rows = []
    for world, found in result["worlds"].items():
        for row in found:
            low, high = row["survived_low"], row["survived_high"]
            rows.append(
                (
                    world,
                    row["evader"],
                    f"{100 * row['survived']:.1f} %",
                    f"{100 * low:.1f}-{100 * high:.1f}",
                    f"{100 * row['touched_obstacle']:.1f} %",
                    f"{100 * row['caught']:.1f} %",
                    number(row["mean_closest_m"], 3),
                    number(row["closest_over_bound"], 3),
                    number(row["floor_used_m2"], 2),
                    number(row["turning_rad_s"], 3),
                    number(row["decision_ms"], 2),
                )
            )
    return table(head, rows)


def others(result: Result) -> str:
    """Looking ahead in an empty room, by other pursuers."""
    head = ("pursuer", "games", "survives", "mean survival [s]", "closest [m]")
    rows = [
        (
            row["pursuer"],
            str(row["games"]),
            f"{100 * row['survived']:.0f} %",
            number(row["mean_survival_s"], 1),
            number(row["mean_closest_m"], 3),
        )
        for row in result["others"]
    ]
    return table(head, rows)


def sizes(result: Result) -> str:
    """Share that survives in square rooms without obstacles, by size."""
    names = [row["evader"] for row in result["sizes"][0]["rows"]]
    rows = [
        (
            f"{entry['size_m']:g} x {entry['size_m']:g} m",
            *(f"{100 * row['survived']:.0f} %" for row in entry["rows"]),
        )
        for entry in result["sizes"]
    ]
    return table(("room", *names), rows)
