"""People approaching a standing robot from all directions."""

from collections.abc import Mapping
from typing import Any

from .markdown import counted, number, table


def people(*results: Mapping[str, Any]) -> str:
    """List contacts and distances by walking speed."""
    rows = [
        (
            f"{row['speed_m_s']:g}",
            str(row["number"]),
            counted(row["contacts"], row["number"]),
            counted(row["falls"], row["number"]),
            number(row["closest_m"], 2),
            number(row["mean_closest_m"], 2),
            number(row["triggered_at_m"], 1),
        )
        for result in results
        for row in result["people"]
    ]
    head = (
        "speed [m/s]",
        "people",
        "touched",
        "fell",
        "closest [m]",
        "mean [m]",
        "begun at [m]",
    )
    return table(head, rows)


def seen(*results: Mapping[str, Any]) -> str:
    """List people who approach a robot with cameras or a lidar."""
    rows = []
    for result in results:
        settings = result["settings"]
        body, speed = settings["body"], f"{settings['speed_m_s']:g}"
        rows += [
            (
                *(row["sensing"], body, speed),
                "the front" if ahead else "behind",
                str(row["number"]),
                counted(row["contacts"], row["number"]),
                counted(row["falls"], row["number"]),
                number(row["closest_m"], 2),
                number(row["mean_closest_m"], 2),
                number(row["triggered_at_m"], 1),
            )
            for row in result["came"]
            for ahead in [row["from"] == "ahead"]
        ]
    head = (
        *("seen by", "body", "speed [m/s]", "come from", "people"),
        *("touched", "fell", "closest [m]", "mean [m]", "begun at [m]"),
    )
    return table(head, rows)


def reactions(*results: Mapping[str, Any]) -> str:
    """List what came of people by reaction, drawn at random and searched."""
    found: dict[str, dict[bool, Mapping[str, Any]]] = {}
    for result in results:
        for row in result["reactions"]:
            found.setdefault(row["reaction"], {})[row["hard"]] = row
    rows = [
        (
            reaction,
            *(
                f"{row['number']}: {counted(row['contacts'], row['number'])}"
                for row in kinds
            ),
            number(min(row["closest_m"] for row in kinds), 2),
            number(kinds[0]["median_closest_m"], 2),
        )
        for reaction, by_kind in found.items()
        for kinds in [(by_kind[False], by_kind[True])]
    ]
    head = (
        *("reaction", "drawn: touched", "searched: touched"),
        *("closest [m]", "median of drawn [m]"),
    )
    return table(head, rows)
