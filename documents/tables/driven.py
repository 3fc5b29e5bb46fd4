"""Duels of robots that were driven by velocity."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

WAYS = {"ros2": "ROS 2", "naoqi": "NAOqi"}


def duels(result: Mapping[str, Any]) -> str:
    """One row for each duel."""
    return table(
        (
            "over",
            "body",
            "time",
            "outcome",
            "pursuer's radius [m]",
            "evader's radius [m]",
            "on the circle since [s]",
            "late ticks",
        ),
        (
            (
                WAYS[row["way"]],
                row["body"],
                "lock step" if row["lock_step"] else "real",
                row["outcome"],
                number(row["pursuer_radius_m"]),
                number(row["evader_radius_m"]),
                number(row["converged_at_s"], 1),
                "-" if row["lock_step"] else str(row["late_ticks"]),
            )
            for row in result["rows"]
        ),
    )
