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


def shield_duels(result: Result) -> str:
    """Count contacts of duels with a shield, of templates and of bodies."""
    head = (
        "robot",
        "person [m/s], radius [m]",
        "of",
        "duels",
        "certified",
        "after [s]",
        "contacts",
        "certified [m]",
        "least [m]",
    )
    rows = []
    robots = [found["robot"] for found in result["rows"]]
    by_robot = sorted(result["rows"], key=lambda x: robots.index(x["robot"]))
    for found in by_robot:
        duels, contact = found["duels"], found["contact_m"]
        certified = [d for d in duels if d["certified_s"] is not None]
        counted_ones = [d for d in certified if d["within"]]
        contacts = sum(
            d["outcome"] == "contact" or d["least_m"] < contact
            for d in counted_ones
        )
        begins = sorted(d["certified_s"] for d in certified)
        rows.append(
            (
                found["robot"],
                f"{number(found['person_speed_m_s'], 2)}, "
                f"{number(found['turning_radius_m'], 1)}",
                found["level"],
                str(len(duels)),
                str(len(certified)),
                number(begins[len(begins) // 2], 1),
                counted(contacts, len(counted_ones)),
                number(contact, 2),
                number(min(d["least_m"] for d in counted_ones), 2),
            )
        )
    return table(head, rows)
