"""People approaching a standing robot from all directions."""

from collections.abc import Mapping
from typing import Any

from .markdown import counted, number, table


def people(*results: Mapping[str, Any]) -> str:
    """List contacts and distances by body, sensing and walking speed."""
    rows = [
        (
            result["settings"]["body"],
            row["sensing"],
            f"{row['speed_m_s']:g}",
            str(row["number"]),
            counted(row["contacts"], row["number"]),
            counted(row["falls"], row["number"]),
            number(row["closest_m"], 2),
            number(row["mean_closest_m"], 2),
            number(row["template_closest_m"], 2),
            number(row["triggered_at_m"], 1),
            number(row["theory_room_m"], 2),
        )
        for result in results
        for row in result["people"]
    ]
    head = (
        "body",
        "seen by",
        "speed [m/s]",
        "people",
        "touched",
        "fell",
        "closest [m]",
        "mean [m]",
        "template's closest [m]",
        "begun at [m]",
        "theory's room at 3.5 m [m]",
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
    rows = [
        (
            row["sensing"],
            row["reaction"],
            "searched" if row["hard"] else "drawn",
            str(row["number"]),
            counted(row["contacts"], row["number"]),
            counted(row["falls"], row["number"]),
            number(row["closest_m"], 2),
            number(row["median_closest_m"], 2),
            ", ".join(f"{n} {c}" for c, n in row["causes"].items()) or "-",
        )
        for result in results
        for row in result["reactions"]
    ]
    head = (
        *("seen by", "reaction", "people", "games", "touched", "fell"),
        *("closest [m]", "median [m]", "causes"),
    )
    return table(head, rows)
