"""One look for every figure: colours, sizes, units."""

from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

from ..outputs import writing  # noqa: E402

PURSUER = "#c8321f"
EVADER = "#1f5fbf"
THEORY = "#444444"
LEFT, RIGHT = "#0f7b6c", "#b5651d"
COLOURS = {"pursuer": PURSUER, "evader": EVADER}

plt.rcParams.update(
    {
        "figure.dpi": 110,
        "savefig.dpi": 150,
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.grid": True,
        "grid.alpha": 0.25,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "figure.constrained_layout.use": True,
    }
)


def save(figure: Any, file: Path | str) -> None:
    """Write a figure whole, or not at all, and let it go.

    Args:
        figure: Of matplotlib.
        file: What to write; its suffix says which kind.

    Raises:
        OutputError: If it cannot be written.
    """
    file, drawn = Path(file), BytesIO()
    try:
        # In memory: what draws does not end well on a disk that is full.
        figure.savefig(drawn, format=file.suffix[1:] or "png")
    finally:
        plt.close(figure)
    with writing(file) as draft:
        draft.write_bytes(drawn.getvalue())


__all__ = [
    "COLOURS",
    "EVADER",
    "LEFT",
    "PURSUER",
    "RIGHT",
    "THEORY",
    "plt",
    "save",
]
