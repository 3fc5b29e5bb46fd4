"""Walking policies: velocities that they deliver, duels on hardware bodies."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]
AXES = ("forward", "lateral", "turn")
UNITS = ("m/s", "m/s", "rad/s")


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


def tracking(*results: Result) -> str:
    """List gain, lag and halting motion by axis."""
    head = (
        *("policy", "axis", "delivered", "gain"),
        *("lag [s]", "halts in [m, rad]"),
    )
    rows = []
    for result in results:
        found = result["measured"]
        for i, axis in enumerate(AXES):
            low, high = found["limits"][axis]
            rows.append(
                (
                    result["settings"]["label"] if i == 0 else "",
                    axis,
                    f"{number(low, 2)} to {number(high, 2)} {UNITS[i]}",
                    number(found["gains"][i][i], 2),
                    number(found["lag_s"][i], 2),
                    number(found["halting"][i], 2),
                )
            )
    return table(head, rows)
