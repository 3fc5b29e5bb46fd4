"""Figure of a map over initial poses."""

from typing import Any

import numpy as np
from matplotlib.colors import ListedColormap

from ..theory.unicycle.circles import Circle
from ..theory.unicycle.start_maps import StartMap
from .figure_style import new_figure, save

_QUANTITIES = (
    ("closest_distance", "closest approach [m]", "viridis"),
    ("settled_time", "time to reach the circle [s]", "cividis"),
)
# Colours of Okabe and Ito, distinct with colour blindness, too.
_COLOURS = ("#f0e442", "#0072b2", "#cc79a7", "#d55e00", "#009e73", "#56b4e9")


def draw_map(
    found: StartMap, path: str, *, circles: tuple[Circle, ...], body: float
) -> None:
    """Draw closest approach, settling time and circle over the bearings.

    Args:
        found: The map; at most four of its distances are drawn.
        path: File to write; its suffix gives the format.
        circles: Circles of the game. If there are several, the one that each
            game ends on is drawn.
        body: Capture distance, in [m], drawn as a line.
    """
    count = len(found.distances)
    picks = np.unique(np.linspace(0, count - 1, min(4, count)).astype(int))
    count = 3 if len(circles) > 1 else 2
    figure = new_figure(2.7 * len(picks) + 1.2, 2.4 * count + 1.0)
    axes = figure.subplots(
        count, len(picks), sharex=True, sharey=True, squeeze=False
    )
    for row, quantity in zip(axes, _QUANTITIES, strict=False):
        _draw_quantity(figure, row, found, picks, quantity, body)
    if count == 3:
        _draw_circles(figure, axes[2], found, picks, circles)
    for ax, i in zip(axes[0], picks, strict=True):
        ax.set_title(f"initial distance {found.distances[i]:.2f} m")
    for ax in axes[-1]:
        ax.set_xlabel("bearing of the pursuer\nfrom the evader [deg]")
    for ax in axes[:, 0]:
        ax.set_ylabel("bearing of the evader\nfrom the pursuer [deg]")
    save(figure, path)


def _draw_quantity(
    figure: Any,
    row: Any,
    found: StartMap,
    picks: Any,
    quantity: tuple[str, str, str],
    body: float,
) -> None:
    """Draw one quantity; grey where captured or not settled."""
    name, label, colours = quantity
    values, closest = found.grid(name).copy(), found.grid("closest_distance")
    values[~np.isfinite(values)] = np.nan
    high = 1.0 if np.isnan(values).all() else float(np.nanmax(values))
    aims = np.rad2deg(found.pursuer_errors)
    bearings = np.rad2deg(found.bearings)
    for ax, i in zip(row, picks, strict=True):
        image = ax.pcolormesh(
            bearings, aims, values[i], vmin=0.0, vmax=high, cmap=colours
        )
        ax.set_facecolor("0.8")
        ax.grid(visible=False)
        if closest[i].min() <= body < closest[i].max():
            ax.contour(bearings, aims, closest[i], [1.001 * body], colors="w")
    figure.colorbar(image, ax=list(row), label=label)


def _draw_circles(
    figure: Any,
    row: Any,
    found: StartMap,
    picks: Any,
    circles: tuple[Circle, ...],
) -> None:
    """Draw the circle that games end on; grey where captured or unsettled."""
    numbers = found.grid("circle").astype(float)
    numbers[numbers < 0.0] = np.nan
    count = len(circles)
    for ax, i in zip(row, picks, strict=True):
        image = ax.pcolormesh(
            np.rad2deg(found.bearings),
            np.rad2deg(found.pursuer_errors),
            numbers[i],
            vmin=-0.5,
            vmax=count - 0.5,
            cmap=ListedColormap(_COLOURS[:count]),
        )
        ax.set_facecolor("0.8")
        ax.grid(visible=False)
    bar = figure.colorbar(
        image, ax=list(row), ticks=range(count), label="circle, distance [m]"
    )
    names = {1: "main", -1: "reversed"}
    bar.ax.set_yticklabels(
        [f"{names[c.direction]}\n{c.distance_m:.3g}" for c in circles]
    )
