"""Games of any number of players: teams, and robots among people."""

from collections.abc import Mapping
from typing import Any

from .markdown import counted, number, table

Result = Mapping[str, Any]
LEGS = {True: "learned legs", False: "the paper's legs"}


def teams(result: Result) -> str:
    """List captures and closest approaches of teams against teams."""
    head = (
        "pursuers",
        "evaders",
        "games",
        "captured",
        "mean closest [m]",
        "closest [m]",
    )
    rows = [
        (
            f"`{row['pursuers']}`",
            f"`{row['evaders']}`",
            str(row["games"]),
            counted(row["captured"]["number"], row["games"]),
            number(row["mean_closest_m"]),
            number(row["least_closest_m"]),
        )
        for row in result["rows"]
    ]
    return table(head, rows)


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


def crowds(*results: Result) -> str:
    """List how robots cross a room among people, a row for each result."""
    head = (
        "robot",
        "games",
        "success",
        "collided",
        "fell",
        "time to the goal [s]",
        "below 0.45 m",
        "below 1.2 m",
    )
    rows = []
    for result in results:
        (row,) = result["rows"]
        (robot,) = row["crowd"]
        rows.append(
            (
                _robot(result["settings"], robot["name"]),
                str(row["games"]),
                counted(robot["success"]["number"], row["games"]),
                counted(robot["collided"]["number"], row["games"]),
                counted(row["fell"]["number"], row["games"]),
                number(robot["mean_time_s"], 1),
                f"{100.0 * robot['share_below_0_45']:.1f} %",
                f"{100.0 * robot['share_below_1_2']:.0f} %",
            )
        )
    return table(head, rows)


def _robot(settings: Mapping[str, Any], name: str) -> str:
    """Return what kind of robot a player is, and at which level."""
    (own,) = (p for p in settings["players"] if p["name"] == name)
    if settings["level"] != "physics":
        return f"{own['robot'].upper()}, template at `{settings['level']}`"
    legs = LEGS[bool(own.get("legs", {}).get("network"))]
    return f"{own['robot'].upper()} on {legs}, physics"
