"""Common style of all figures: colours, fonts, saving."""

import os
import sys
from collections.abc import Iterable, Mapping
from functools import partial
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
from .figure_sizes import sheet  # noqa: E402
from .palette import PALETTES, colours_in  # noqa: E402

LIGHT = PALETTES["light"]
PURSUER, EVADER, THEORY = LIGHT.pursuer, LIGHT.evader, LIGHT.theory
LEFT, RIGHT = LIGHT.others[:2]
MEAN, SWAY, PUSHED = LIGHT.mean, LIGHT.sway, LIGHT.pushed
COLOURS = {"pursuer": PURSUER, "evader": EVADER}
colours_of = partial(colours_in, "light")
# Without dates, the same run gives the same file.
UNDATED: dict[str, dict[str, Any]] = {
    "pdf": {"CreationDate": None},
    "svg": {"Date": None},
}

plt.rcParams.update(
    {
        "figure.dpi": 110,
        "savefig.dpi": 150,
        "axes.prop_cycle": cycler(color=[EVADER, PURSUER, LEFT, RIGHT]),
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.alpha": 0.25,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "figure.constrained_layout.use": True,
        "mathtext.fontset": "stix",
        # Text stays editable in PDF and SVG.
        "pdf.fonttype": 42,
        "svg.fonttype": "none",
        "svg.hashsalt": "stepaside",
    }
)


def new_figure(width: float, height: float) -> Any:
    """Create a figure on the current sheet.

    Args:
        width: Width on the sheet "screen", in [inch].
        height: Height on the sheet "screen", in [inch]; on a narrower sheet
            it shrinks less than the width, since fonts do not shrink.

    Returns:
        Figure of Matplotlib.
    """
    _set_fonts()
    sheet_width = sheet().width
    if sheet_width is None:
        return plt.figure(figsize=(width, height))
    scale = sheet_width / width
    return plt.figure(figsize=(sheet_width, max(scale, scale**0.75) * height))


def panel_grid(
    count: int, width: float, height: float, *, columns: int = 4
) -> tuple[Any, Any]:
    """Open a figure with a grid of panels that share their vertical axis.

    Args:
        count: Number of panels; further places of the grid stay empty.
        width: Width of one panel, in [inch].
        height: Height of one panel, in [inch].
        columns: Greatest number of columns; two on a narrow sheet.

    Returns:
        Figure and axes of Matplotlib. Shape of the axes (lines, columns).
    """
    columns = min(2 if sheet().narrow else columns, count)
    lines = -(-count // columns)
    figure = new_figure(width * columns, height * lines)
    axes = figure.subplots(lines, columns, squeeze=False, sharey=True)
    for axis in axes.flat[count:]:
        axis.set_visible(False)
    return figure, axes


def add_common_legend(
    figure: Any,
    axes: Iterable[Any],
    further: Mapping[str, Any] | None = None,
    **style: Any,
) -> None:
    """Add one legend below a figure, with every label of its axes once.

    Args:
        figure: Figure of Matplotlib.
        axes: Axes with labels.
        further: Handles of Matplotlib that are in no axes, by label.
        style: Further arguments of the legend.
    """
    handles: dict[str, Any] = {}
    for axis in axes:
        found, labels = axis.get_legend_handles_labels()
        handles |= dict(zip(labels, found, strict=True))
    handles |= further or {}
    if handles:
        place = "outside lower center"
        figure.legend(handles.values(), handles.keys(), loc=place, **style)


def _set_fonts() -> None:
    """Set fonts and line widths of the sheet; read when figures are drawn."""
    sheet_width, font, family, _ = sheet()
    line = 0.8 if sheet_width is None else 0.5
    plt.rcParams.update(
        {
            "font.family": list(family),
            "font.size": font,
            "axes.titlesize": font + 0.5,
            "axes.labelsize": font,
            "xtick.labelsize": font - 1.0,
            "ytick.labelsize": font - 1.0,
            "legend.fontsize": font - 1.0,
            "figure.titlesize": font + 2.0,
            "axes.linewidth": line,
            "grid.linewidth": line,
            "xtick.major.width": line,
            "ytick.major.width": line,
        }
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

    Args:
        axes: Matplotlib axes.
        level: Height of the line, in units of the axes.
        text: Label, to the right of the axes.
        colour: Of line and label.
        line: Style of the line.
        va: Vertical alignment of the label: "bottom" is over the line, "top"
            under it.
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
        fontsize=sheet().font - 1.0,
    )


def save(figure: Any, file: AnyPath) -> None:
    """Write a figure atomically and close it.

    Args:
        figure: Figure of Matplotlib.
        file: File to write; its suffix gives the format.

    Raises:
        OutputError: If it cannot be written.
    """
    buffer = BytesIO()
    try:
        path = as_path(file, "file")
        kind = path.suffix[1:].lower() or "png"
        # To memory first: backends do not recover from a full disk.
        figure.savefig(buffer, format=kind, metadata=UNDATED.get(kind))
    finally:
        plt.close(figure)
    with atomic_draft(path) as draft:
        draft.write_bytes(buffer.getvalue())


__all__ = [
    "COLOURS",
    "EVADER",
    "LEFT",
    "MEAN",
    "PUSHED",
    "PURSUER",
    "RIGHT",
    "SWAY",
    "THEORY",
    "add_common_legend",
    "colours_of",
    "mark_level",
    "new_figure",
    "panel_grid",
    "plt",
    "save",
]
