"""One look for every figure: colours, sizes, units."""

from collections.abc import Iterable
from io import BytesIO
from itertools import cycle
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
from cycler import cycler  # noqa: E402

from ..core.atomic_output import writing  # noqa: E402
from ..core.errors import AnyPath, as_path  # noqa: E402
from .figure_sizes import sheet  # noqa: E402

PURSUER = "#c8321f"
EVADER = "#1f5fbf"
THEORY = "#444444"
LEFT, RIGHT = "#0f7b6c", "#b5651d"
MEAN = "#5b2a86"  # of both players together
SWAY = "#b9a5cf"  # of the same, with every step in it
COLOURS = {"pursuer": PURSUER, "evader": EVADER}
OTHERS = (LEFT, RIGHT, "#6a3d9a", "#8a6d00", "#c0307f", "#3d6b8a")
PUSHED = "#b5006b"
# When it was drawn is no part of a figure: the same run, the same file.
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
        # Letters stay letters, which editors of papers can change.
        "pdf.fonttype": 42,
        "svg.fonttype": "none",
        "svg.hashsalt": "stepaside",
    }
)


def new_figure(width: float, height: float) -> Any:
    """Begin a figure on the sheet that is chosen.

    Args:
        width: That it has on a screen, in [inch].
        height: Likewise; what the sheet narrows is lower by nearly as much,
            since words do not shrink with it.

    Returns:
        Figure of matplotlib.
    """
    _set_words()
    wide = sheet().width
    if wide is None:
        return plt.figure(figsize=(width, height))
    scale = wide / width
    return plt.figure(figsize=(wide, max(scale, scale**0.75) * height))


def _set_words() -> None:
    """Set words as the sheet asks; figures read this when they are drawn."""
    wide, font, family, _ = sheet()
    line = 0.8 if wide is None else 0.5
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
    stands: str = "center",
) -> None:
    """Draw a level across a plot, and name it beside the plot.

    Args:
        axes: Matplotlib axes.
        level: Height of the line, in units of the axes.
        text: Its name; it stands to the right of the axes, on no curve.
        colour: Of both.
        line: Style of the line.
        stands: Whether the name is over the level ("bottom"), under it
            ("top"), or at its height.
    """
    axes.axhline(level, color=colour, ls=line, lw=1.0)
    axes.annotate(
        text,
        (1.0, level),
        (4.0, {"bottom": 1.0, "top": -1.0}.get(stands, 0.0)),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        va=stands,
        color=colour,
        fontsize=sheet().font - 1.0,
    )


def colours_of(players: Iterable[str]) -> dict[str, str]:
    """Colour of each player: of its role, or one that nobody else has.

    Args:
        players: Their names.
    """
    found: dict[str, str] = {}
    others = cycle(OTHERS)
    for name in players:
        found[name] = COLOURS.get(name) or next(others)
    return found


def save(figure: Any, file: AnyPath) -> None:
    """Write a figure whole, or not at all, and let it go.

    Args:
        figure: Of matplotlib.
        file: What to write; its suffix says which kind.

    Raises:
        OutputError: If it cannot be written.
    """
    drawn = BytesIO()
    try:
        path = as_path(file, "file")
        kind = path.suffix[1:].lower() or "png"
        # In memory: what draws does not end well on a disk that is full.
        figure.savefig(drawn, format=kind, metadata=UNDATED.get(kind))
    finally:
        plt.close(figure)
    with writing(path) as draft:
        draft.write_bytes(drawn.getvalue())


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
    "colours_of",
    "mark_level",
    "new_figure",
    "plt",
    "save",
]
