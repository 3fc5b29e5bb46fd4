"""Survival in rooms by opponent and by size of the room."""

from collections.abc import Mapping
from typing import Any

from .markdown import interval, number, table

Result = Mapping[str, Any]


def opponents(result: Result) -> str:
    """List survival against each pursuer, with the paper's circle."""
    met = result["opponents"]
    head = (
        "pursuer",
        "circle [m]",
        *(
            f"{each['evader']}, {each['world']} (n = {row['games']})"
            for each in met
            for row in each["rows"][:1]
        ),
    )
    rows = [
        (
            row["pursuer"],
            number(row["circle_distance_m"], 3),
            *(_survived(each["rows"][i]) for each in met),
        )
        for i, row in enumerate(met[0]["rows"])
    ]
    return table(head, rows)


def _survived(row: Mapping[str, Any]) -> str:
    """Return the survival rate with its 95 % interval."""
    ends = 100 * row["survived_low"], 100 * row["survived_high"]
    return f"{100 * row['survived']:.0f} % ({interval(*ends, 0)})"


def ladder(result: Result) -> str:
    """List survival of both evaders, unless it is that of every game."""
    head = (
        *("world", "pursuer", "games"),
        *("look-ahead", "robust", "robust decides, mean, longest [ms]"),
    )
    rows = []
    for world, found in result["worlds"].items():
        evaders: dict[str, dict[str, Any]] = {}
        for row in found["rows"]:
            evaders.setdefault(row["pursuer"], {})[row["evader"]] = row
        for pursuer, by_name in evaders.items():
            both = [by_name[name] for name in ("look-ahead", "robust")]
            if all(row["survived"] == 1.0 for row in both):
                continue
            rows.append(
                (
                    world,
                    pursuer,
                    str(both[0]["games"]),
                    *(_survived(row) for row in both),
                    f"{both[1]['decision_ms']:.0f}, "
                    f"{both[1]['longest_decision_ms']:.0f}",
                )
            )
    return table(head, rows)
