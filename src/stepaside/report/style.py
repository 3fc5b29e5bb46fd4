"""One look for every figure: colours, sizes, units."""

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

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

__all__ = ["COLOURS", "EVADER", "LEFT", "PURSUER", "RIGHT", "THEORY", "plt"]
