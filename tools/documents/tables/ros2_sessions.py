"""Messages exchanged with real ROS 2 nodes."""

from collections.abc import Mapping
from typing import Any

from .markdown import table


def peers(result: Mapping[str, Any]) -> str:
    """List one row per message or action, one column per distribution."""
    found = result["distributions"]
    head = (
        *("from", "to", "what", "type"),
        *(f"{each['name']} ({each['middleware']})" for each in found),
    )
    rows = []
    for same in zip(*(each["rows"] for each in found), strict=True):
        keys = {(row["way"], row["topic"], row["type"]) for row in same}
        if len(keys) != 1:
            raise ValueError(f"rows of distributions differ: {sorted(keys)}")
        ((way, topic, kind),) = keys
        sender, receiver = way.split(" to ")
        what = f"`{topic}`" if " " not in topic else topic
        cells = (("yes" if row["passed"] else "no") for row in same)
        rows.append((sender, receiver, what, kind, *cells))
    return table(head, rows)
