"""Walking policies: duels on the hardware body."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]


def on_hardware(result: Result) -> str:
    """List duels on the hardware body; several duels as a range."""
    head = ("policy", "outcome", "distance, of theory", "angle [deg]")
    rows = []
    for label, found in result["networks"].items():
        duels = found["duels"]
        outcomes = sorted({duel["outcome"] for duel in duels})
        ends = [
            " to ".join(
                number(end(duel[key] for duel in duels), digits)
                for end in (min, max)
            )
            for key, digits in (("distance_ratio", 3), ("angle_deg", 0))
        ]
        rows.append((label, f"{len(duels)} {', '.join(outcomes)}", *ends))
    return table(head, rows)
