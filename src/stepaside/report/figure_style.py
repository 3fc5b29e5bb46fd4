"""Common style of all figures: colours, fonts, fixed margins, saving."""

import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from io import BytesIO
from typing import Any

import matplotlib

# Figures go to files. A session that plots itself keeps its own backend.
if "MPLBACKEND" not in os.environ and "matplotlib.pyplot" not in sys.modules:
    matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
from cycler import cycler  # noqa: E402

from ..core.atomic_output import atomic_draft  # noqa: E402
from ..core.errors import AnyPath, as_path  # noqa: E402
from ..games.run import Run  # noqa: E402
from .palette import PALETTES, colours_in  # noqa: E402

LIGHT = PALETTES["light"]
PURSUER, EVADER, THEORY = LIGHT.pursuer, LIGHT.evader, LIGHT.theory
LEFT, RIGHT = LIGHT.others[:2]
MEAN, SWAY, PUSHED = LIGHT.mean, LIGHT.sway, LIGHT.pushed
COLOURS = {"pursuer": PURSUER, "evader": EVADER}
LINES = ("-", "--", ":", "-.")
MARGIN = 0.75  # left of the panels, for ticks and label, in [inch]
AXIS = 0.42  # below a row of panels, for ticks and label, in [inch]
LEGEND_LINE = 0.19  # height of a line of a legend, in [inch]
FONT = 9.0  # in [pt]
# Without dates, the same run gives the same file.
UNDATED: dict[str, dict[str, Any]] = {
    "pdf": {"CreationDate": None},
    "svg": {"Date": None},
}

plt.rcParams.update(
    {
        "font.size": FONT,
        "axes.titlesize": FONT + 0.5,
        "axes.labelsize": FONT,
        "xtick.labelsize": FONT - 1.0,
        "ytick.labelsize": FONT - 1.0,
        "legend.fontsize": FONT - 1.0,
        "figure.titlesize": FONT + 2.0,
        "figure.dpi": 110,
        "savefig.dpi": 150,
        "axes.prop_cycle": cycler(color=[EVADER, PURSUER, LEFT, RIGHT]),
        "axes.grid": True,
        "axes.axisbelow": True,
        # Given, so that Matplotlib does not measure all labels for it.
        "axes.titley": 1.0,
        "grid.alpha": 0.25,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "mathtext.fontset": "stix",
        # Text stays editable in PDF and SVG.
        "pdf.fonttype": 42,
        "svg.fonttype": "none",
        "svg.hashsalt": "stepaside",
    }
)


def panels(
    rows: Sequence[str],
    width: float,
    heights: Sequence[float],
    *,
    title: str = "",
    legend: int = 0,
    right: float = 0.2,
    gaps: tuple[float, float] = (0.75, 0.88),
    **more: Any,
) -> tuple[Any, dict[str, Any]]:
    """Open a figure with panels between fixed margins.

    Fixed margins spare the layout that Matplotlib would compute, which takes
    longer than drawing.

    Args:
        rows: Panels of each row, a letter each; a panel covers all places of
            its letter, and "." is an empty place.
        width: Of the figure, in [inch].
        heights: Of each row, in [inch].
        title: Title of the figure.
        legend: Lines that :func:`legend_below` has.
        right: Margin to the right, in [inch].
        gaps: Between columns and between rows, in [inch].
        more: Further arguments of Matplotlib's ``subplot_mosaic``.

    Returns:
        Figure and axes of Matplotlib by their letter.
    """
    top = 0.75 if title else 0.45
    bottom = AXIS + 0.06 + LEGEND_LINE * legend
    height = top + sum(heights) + gaps[1] * (len(rows) - 1) + bottom
    inside = width - MARGIN - right
    columns = len(rows[0])
    figure = plt.figure(figsize=(width, height))
    axes = figure.subplot_mosaic(
        [list(row) for row in rows],
        height_ratios=heights,
        gridspec_kw={
            "left": MARGIN / width,
            "right": 1.0 - right / width,
            "bottom": bottom / height,
            "top": 1.0 - top / height,
            "wspace": gaps[0] * columns / (inside - gaps[0] * (columns - 1)),
            "hspace": gaps[1] * len(rows) / sum(heights),
        },
        **more,
    )
    if title:
        figure.suptitle(title, y=1.0 - 0.08 / height, va="top")
    return figure, axes


def colours_of(run: Run) -> dict[str, str]:
    """Return the colours of the players of a run in figures, by name."""
    return colours_in("light", run.players, run.identities)


def legend_below(
    figure: Any,
    axes: Iterable[Any],
    further: Mapping[str, Any] | None = None,
    **style: Any,
) -> None:
    """Add one legend below a figure, with every label of its axes once.

    Further handles of Matplotlib, by label, are in no axes.
    """
    handles: dict[str, Any] = {}
    for axis in axes:
        found, labels = axis.get_legend_handles_labels()
        handles |= dict(zip(labels, found, strict=True))
    handles |= further or {}
    if handles:
        place = {"loc": "lower center", "borderaxespad": 0.2}
        figure.legend(handles.values(), handles.keys(), **place | style)


def legend_above(axes: Any, title: str, columns: int) -> None:
    """Add a legend between a panel and its title, where it covers no data."""
    axes.set_title(title, pad=18)
    axes.legend(
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        borderaxespad=0.1,
        ncols=columns,
        columnspacing=1.2,
        handlelength=1.6,
    )


def mark_level(
    axes: Any,
    level: float,
    text: str,
    colour: str,
    line: str = "--",
    *,
    va: str = "center",
) -> None:
    """Draw a horizontal line across a plot and label it beside the plot.

    With ``va`` "bottom" the label is over the line, with "top" under it.
    """
    axes.axhline(level, color=colour, ls=line, lw=1.0)
    axes.annotate(
        text,
        (1.0, level),
        (4.0, {"bottom": 1.0, "top": -1.0}.get(va, 0.0)),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        va=va,
        color=colour,
        fontsize=FONT - 1.0,
    )


def save(figure: Any, file: AnyPath) -> None:
    """Write a figure atomically, in the format of the suffix; close it.

    Raises:
        OutputError: If it cannot be written.
    """
    buffer = BytesIO()
    try:
        path = as_path(file, "file")
        kind = path.suffix[1:].lower() or "png"
        # To memory first: backends do not recover from a full disk.
        more: dict[str, Any] = {}
        if kind == "png":
            more = {"pil_kwargs": {"compress_level": 4}}  # much faster than 6
        figure.savefig(buffer, format=kind, metadata=UNDATED.get(kind), **more)
    finally:
        plt.close(figure)
    with atomic_draft(path) as draft:
        draft.write_bytes(buffer.getvalue())


__all__ = ["plt"]  # others draw with the same backend and style
