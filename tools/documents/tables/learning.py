"""Steps per second of environments."""

from collections.abc import Mapping
from typing import Any

from .markdown import table

Result = Mapping[str, Any]


def environments(result: Result) -> str:
    """List steps per second of each environment."""
    names = {
        "vector_steps_per_s": "vector environment, 4096 games",
        "parallel_steps_per_s": "`ParallelDuel`, one game",
        "mpe2_steps_per_s": "`simple_tag_v3` of MPE2, one game",
    }
    rows = [
        (text, f"{result['figures'][name]:,.0f}")
        for name, text in names.items()
        if name in result["figures"]
    ]
    return table(("environment", "steps per second"), rows)
