"""Duels with control over sockets."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

HEAD = (
    "body",
    "time",
    "outcome",
    "pursuer's radius [m]",
    "evader's radius [m]",
    "on the circle since [s]",
    "late ticks",
)
WAYS = {"ros2": "ROS 2", "naoqi": "NAOqi"}


def lola(result: Mapping[str, Any]) -> str:
    """List duels with joint control."""
    return table(
        (*HEAD, "unanswered frames"),
        (
            (*_duel(row), str(row["unanswered_frames"]))
            for row in result["rows"]
        ),
    )


def velocities(result: Mapping[str, Any]) -> str:
    """List duels of robots with velocity control."""
    return table(
        ("over", *HEAD),
        ((WAYS[row["way"]], *_duel(row)) for row in result["rows"]),
    )


def _duel(row: Mapping[str, Any]) -> tuple[str, ...]:
    return (
        row["body"],
        _time(row),
        _outcome(row),
        number(row["pursuer_radius_m"]),
        number(row["evader_radius_m"]),
        number(row["converged_at_s"], 1),
        "-" if row["lock_step"] else str(row["late_ticks"]),
    )


def lateness(result: Mapping[str, Any]) -> str:
    """List how many ticks were late by how much, in real time."""
    rows = [row for row in result["rows"] if not row["lock_step"]]
    bins = list(rows[0]["lateness_ms"])
    return table(
        ("ticks late by [ms]", *bins),
        (
            (row["body"], *(str(row["lateness_ms"][name]) for name in bins))
            for row in rows
        ),
    )


def _time(row: Mapping[str, Any]) -> str:
    return "lock step" if row["lock_step"] else "real"


def _outcome(row: Mapping[str, Any]) -> str:
    outcome: str = row["outcome"]
    if outcome == "completed":
        return outcome
    return f"{outcome} at {row['duration_s']:.1f} s"
