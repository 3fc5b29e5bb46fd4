"""Published humanoids that were tried."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

HEAD = (
    "humanoid",
    "outcome",
    "distance",
    "radii",
    "angle [deg]",
    "closest [m]",
    "version",
)


def reached(result: Mapping[str, Any]) -> str:
    """List the result of each, with lengths relative to theory."""
    return table(HEAD, (_reached(row) for row in result["rows"]))


def _reached(row: Mapping[str, Any]) -> tuple[str, ...]:
    summary = row["summary"]
    theory = summary["theory"]
    outcome = summary["outcome"]
    if outcome != "completed":
        outcome += f" at {summary['duration_s']:.0f} s"
    players = summary["players"]
    evader = _by(players["evader"]["radius_m"], theory["radius_m"])
    other = theory["radius_pursuer_m"]
    pursuer = _by(players["pursuer"]["radius_m"], other)
    angle = summary["relative_orientation_deg"]
    apart = theory["relative_orientation_deg"]
    return (
        row["name"],
        outcome,
        _by(summary["distance_m"], theory["distance_m"]),
        f"{pursuer}, {evader}",
        f"{number(angle, 1)} ({number(apart, 1)})",
        number(summary["min_distance_m"], 2),
        row["results"] or "earlier",
    )


def _by(value: float | None, theory: float | None) -> str:
    if value is None or not theory:
        return "-"
    return f"{100.0 * (value / theory - 1.0):+.1f} %"
