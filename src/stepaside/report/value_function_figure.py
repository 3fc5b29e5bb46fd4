"""Figure of a bound: value and barrier around the pursuer."""

from math import pi, tau
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from ..core.poses import Array
from ..theory.value import CarGame, ValueTable
from ..theory.value.closed_forms import barrier_slice
from ..theory.value.two_cars import barrier
from .figure_sizes import sheet
from .figure_style import (
    EVADER,
    PURSUER,
    THEORY,
    add_common_legend,
    new_figure,
    save,
)

HEADINGS = (0.25, 0.5, 0.75, 1.0)  # angles between the motions, in [pi rad]
POINTS = 161  # along each side of a slice


def draw_bound(
    game: CarGame, table: ValueTable, capture: float, path: str
) -> None:
    """Draw slices of the value function in the pursuer's frame.

    Each slice has one angle between the directions of motion; the evader is
    at (x, y), and an arrow shows its direction of motion.

    Args:
        game: Game of cars.
        table: Its table.
        capture: Capture distance whose barrier is drawn, in [m].
        path: File to write; its suffix gives the format.
    """
    far = min(table.grid.edge, 1.4 * float(barrier(table, capture).max()))
    side = np.linspace(-far, far, POINTS)
    lines = 2 if sheet().narrow else 1
    columns = len(HEADINGS) // lines
    figure = new_figure(3.1 * columns + 0.9, 0.9 + 3.2 * lines)
    grid = figure.subplots(
        lines, columns, sharex=True, sharey=True, squeeze=False
    )
    axes = grid.ravel()
    image: Any = None
    for ax, share in zip(axes, HEADINGS, strict=True):
        image = _draw_slice(ax, game, table, capture, share * pi, side)
    for ax in grid[-1]:
        ax.set_xlabel("ahead of the pursuer [m]")
    for ax in grid[:, 0]:
        ax.set_ylabel("to its left [m]")
    figure.colorbar(
        image,
        ax=list(axes),
        label="closest approach with optimal play [m]",
        shrink=0.8,
    )
    further = {
        name: Line2D([], [], color=colour, lw=2.5)
        for colour, name in (
            ("w", "boundary of the initial poses with certain capture"),
            (PURSUER, "pursuer's direction"),
            (EVADER, "evader's direction, at any position"),
        )
    }
    add_common_legend(
        figure,
        axes[:1],
        further,
        ncols=1 if sheet().narrow else 5,
        frameon=True,
        facecolor="0.82",  # so that the white line is visible
    )
    save(figure, path)


def _draw_slice(
    ax: Any,
    game: CarGame,
    table: ValueTable,
    capture: float,
    theta: float,
    side: Array,
) -> Any:
    """Draw one slice of the value function; return its image.

    Args:
        ax: Matplotlib axes.
        game: Game of cars.
        table: Its table.
        capture: Capture distance whose barrier is drawn, in [m].
        theta: Angle between the directions of motion, in [rad].
        side: Coordinates along each side of the slice, in [m].
    """
    x, y = np.meshgrid(side, side)
    values = table.value(np.stack([x, y, np.full_like(x, theta)], axis=-1))
    values[np.hypot(x, y) > table.grid.edge] = np.nan
    far = float(side[-1])
    image = ax.pcolormesh(
        x, y, values, vmin=0.0, vmax=far, cmap="cividis", rasterized=True
    )
    ax.contour(x, y, values, [capture], colors="w", linewidths=1.5)
    if game.identical:
        unit = game.unit
        points, _ = barrier_slice(capture / unit, theta)
        label = "the same boundary, computed directly"
        ax.plot(*(unit * points.T), ":", color=THEORY, lw=1.5, label=label)
    circle = np.linspace(0.0, tau, 100)
    ring = capture * np.cos(circle), capture * np.sin(circle)
    label = f"capture distance {capture:.3g} m"
    ax.plot(*ring, color=PURSUER, lw=0.8, label=label)
    _arrow(ax, 0.0, 0.0, 0.0, 0.2 * far, PURSUER)
    _arrow(ax, 0.0, 0.75 * far, theta, 0.2 * far, EVADER)
    ax.set_title(f"directions {np.rad2deg(theta):.0f}° apart")
    ax.set_aspect("equal")
    ax.grid(visible=False)
    return image


def _arrow(
    ax: Any, x: float, y: float, heading: float, length: float, colour: str
) -> None:
    ax.annotate(
        "",
        (x + length * np.cos(heading), y + length * np.sin(heading)),
        (x, y),
        arrowprops={"color": colour, "width": 2.0, "headwidth": 8.0},
    )
