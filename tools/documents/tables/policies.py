"""Walking policies: velocities that they deliver, duels on their circle."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

Result = Mapping[str, Any]
POLICIES = {
    "legs-fastsac_g1_29dof": "G1, 29 joints, holosoma",
    "legs-g1_12dof": "G1, 12 joints, recurrent, legged_gym",
    "legs-t1_12dof": "T1, 12 joints, Booster Gym",
    "legs-T1": "T1, 13 joints, B-Human",
    "legs-K1": "K1, 12 joints, B-Human",
    "legs-nao": "NAO, 12 joints, B-Human",
}
AXES = ("forward", "lateral", "turn")
UNITS = ("m/s", "m/s", "rad/s")


def tracking(results: Mapping[str, Result]) -> str:
    """List gain, lag and halting motion by axis."""
    head = (
        *("policy", "axis", "delivered", "gain"),
        *("lag [s]", "halts in [m, rad]"),
    )
    rows = []
    for name, words in POLICIES.items():
        if name not in results:
            continue
        found = results[name]["measured"]
        for i, axis in enumerate(AXES):
            low, high = found["limits"][axis]
            rows.append(
                (
                    words if i == 0 else "",
                    axis,
                    f"{number(low, 2)} to {number(high, 2)} {UNITS[i]}",
                    number(found["gains"][i][i], 2),
                    number(found["lag_s"][i], 2),
                    number(found["halting"][i], 2),
                )
            )
    return table(head, rows)
