"""Printed output, values of many duels beside theory, and walks."""

from collections.abc import Mapping
from typing import Any

from .markdown import counted, interval, number, table

Result = Mapping[str, Any]
VALUES = {  # of duels: label, decimals, and value of theory
    "players.pursuer.radius_m": ("pursuer radius [m]", 3, "radius_m"),
    "players.evader.radius_m": ("evader radius [m]", 3, "radius_m"),
    "distance_m": ("distance [m]", 3, "distance_m"),
    "relative_orientation_deg": (
        *("between headings [deg]", 1, "relative_orientation_deg"),
    ),
    "converged_at_s": ("on the circle since [s]", 1, ""),
    "min_distance_m": ("closest approach [m]", 3, ""),
    "triggered_at_distance_m": ("evasion begins at [m]", 3, ""),
    "planning.min_zmp_margin_m": ("ZMP margin [m]", 4, ""),
}


def printed(result: Result) -> str:
    """Return the printed output of a command, as a code fence."""
    return f"```\n{result['printed'].rstrip()}\n```"


def spreads(result: Result) -> str:
    """List values of duels of one kind: mean, its interval, and range."""
    head = ("what", "theory", "mean", "95 % of it", "least", "greatest")
    (row,) = result["rows"]
    lines = []
    for key, (words, digits, theory) in VALUES.items():
        found = row[key]
        expected = row[f"theory.{theory}"]["mean"] if theory else None
        mean, half = found["mean"], found["half"]
        lines.append(
            (
                words,
                number(expected, digits),
                number(mean, digits),
                interval(mean - half, mean + half, digits),
                number(found["min"], digits),
                number(found["max"], digits),
            )
        )
    return table(head, lines)


def fast_walks(*results: Result) -> str:
    """List falls, speed and turning with the fast gait, by body and way."""
    lines = []
    for result in results:
        for way, backward in (("forward", False), ("backward", True)):
            rows = [
                row
                for row in result["rows"]
                if ("backward" in row["walker.strategy"]) is backward
            ]
            number_of = sum(row["number"] for row in rows)
            survived = sum(row["survived"]["count"] for row in rows)
            ends = []
            for key in ("speed_m_s", "speed_ratio", "yaw_ratio"):
                found = [row[f"walking.{key}"] for row in rows]
                ends.append(
                    interval(
                        min(each["min"] for each in found if each),
                        max(each["max"] for each in found if each),
                    )
                )
            lines.append(
                (
                    f"{result['settings']['label']}, {way}",
                    str(number_of),
                    counted(number_of - survived, number_of),
                    *ends,
                )
            )
    head = (
        *("walks of the fast gait", "n", "falls", "speed [m/s]"),
        *("speed / planned", "turning / planned"),
    )
    return table(head, lines)
