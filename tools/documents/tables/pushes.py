"""Push limits of a walk, with the bounds of the pendulum."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

WORDS = {
    "open-loop": "open loop",
    "closed-form": "closed-form with feedback",
}


def methods(result: Mapping[str, Any]) -> str:
    """List limits over bounds for each method, over directions and phases."""
    head = (
        "method",
        "of the pendulum's bound, median",
        "least",
        "most",
        "above it",
        "of an impulse's, median",
        "above that",
        "least push [N s]",
    )
    rows = []
    for name, found in result["summary"].items():
        of = f" of {found['cases']}"
        rows.append(
            (
                WORDS.get(name, name),
                number(found["median_of_bound"], 2),
                number(found["least_of_bound"], 2),
                number(found["most_of_bound"], 2),
                f"{found['above_bound']}{of}",
                number(found["median_of_impulse_bound"], 2),
                f"{found['above_impulse_bound']}{of}",
                number(found["least_n_s"], 1),
            )
        )
    return table(head, rows)
