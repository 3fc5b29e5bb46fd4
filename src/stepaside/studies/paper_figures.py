"""Figures of the paper, as described by captions and text, with ours."""

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

FILE = Path(__file__).with_suffix(".toml")
TICK = 0.5  # distance of the ticks of the axes of Fig. 2, in [m]
NOT_MEASURED = "not measured"


class FigureRow(NamedTuple):
    """One property of a figure of the paper, with our value.

    Attributes:
        figure: Number of the figure.
        what: Name of the property.
        paper: Value by caption or text.
        source: Caption or section that gives it.
        ours: Our value.
    """

    figure: str
    what: str
    paper: str
    source: str
    ours: str


def paper_figures(
    rows: Sequence[Mapping[str, Any]], turns: float, end: float
) -> list[FigureRow]:
    """Compare the figures of the paper with ours.

    Args:
        rows: Rows of the claims, as JSON objects; missing claims appear as
            "not measured".
        turns: Turns of the pursuer in our version of Fig. 2.
        end: Time of its last snapshot, in [s].
    """
    measured = {row["name"]: row["measured"] for row in rows}
    filled = []
    for entry in tomllib.loads(FILE.read_text("utf-8"))["figure"]:
        values = [measured.get(name) for name in entry.pop("claims", ())]
        text = NOT_MEASURED
        if None not in values:
            ticks = (values[0] or 0.0) / TICK if values else 0.0
            text = entry["ours"].format(
                *values, turns=turns, end=end, ticks=ticks, across=2.0 * ticks
            )
        filled.append(FigureRow(**(entry | {"ours": text})))
    return filled
