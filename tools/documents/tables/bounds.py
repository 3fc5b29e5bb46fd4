"""Bound of the closest approach, and evaders beside it."""

from collections.abc import Mapping
from typing import Any

from .markdown import NONE, counted, number, table

Result = Mapping[str, Any]


def evaders(result: Result) -> str:
    """Compare closest approaches of several evaders with the bound."""
    head = (
        "starts",
        "evader",
        "mean closest [v/k]",
        "of the bound",
        "best over this",
        "most above the bound [v/k]",
    )
    rows = [
        (
            starts,
            row["evader"],
            number(row["closest"], 3),
            number(row["over_bound"], 3),
            number(row["best_over_this"], 2),
            number(row["most_above"], 4),
        )
        for starts, found in result["pursuit"]["boxes"].items()
        for row in found
    ]
    return table(head, rows)


def chauffeur(result: Result) -> str:
    """Compare grids of the chauffeur's game with the closed form."""
    cells = [grid["cells"] for grid in result["rows"][0]["grids"]]
    head = (
        "γ",
        "closed form [R]",
        *(f"{n} cells [R]" for n in cells),
        "off [%]",
        "barrier off, worst [cells]",
    )
    rows = [
        (
            number(row["ratio"], 3),
            number(row["closed"], 4),
            *(number(grid["guaranteed"], 4) for grid in row["grids"]),
            f"{100.0 * row['grids'][-1]['error']:.2f}",
            NONE
            if row["barrier"] is None
            else number(row["barrier"]["worst_cells"], 2),
        )
        for row in result["rows"]
    ]
    return table(head, rows)


def shield_maps(result: Result) -> str:
    """Count contacts of games from certified starts, and from others."""
    head = (
        "robot",
        "person [m/s], radius [m]",
        "contact [m]",
        "required [m]",
        "start ahead, aside [m]",
        "starts",
        "games",
        "contacts",
        "closest [m]",
    )
    rows = []
    for name, found in result["maps"].items():
        for starts in ("certified", "outside"):
            kinds = found[starts].values()
            games = sum(kind["games"] for kind in kinds)
            if not games:
                continue
            contacts = sum(kind["contacts"] for kind in kinds)
            rows.append(
                (
                    name,
                    f"{number(found['person_speed_m_s'], 2)}, "
                    f"{number(found['turning_radius_m'], 1)}",
                    number(found["contact_m"], 2),
                    number(found["required_m"], 2),
                    f"{number(found['start_ahead_m'], 2)}, "
                    f"{number(found['start_aside_m'], 2)}"
                    if found["winnable"]
                    else "no start certified",
                    starts,
                    str(games),
                    counted(contacts, games),
                    number(min(kind["closest_m"] for kind in kinds), 2),
                )
            )
    return table(head, rows)
