"""Figures of value functions: two cars, and a robot against a person."""

from math import pi
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from ..core.errors import AnyPath
from ..core.poses import Array
from ..theory.value import CarGame, ChauffeurGame, ValueTable
from ..theory.value.chauffeur import guaranteed_distance
from ..theory.value.two_cars import barrier_slice
from .figure_style import EVADER, PURSUER, THEORY, legend_below, panels, save
from .overlays import ring

HEADINGS = (0.25, 0.5, 0.75, 1.0)  # angles between the motions, in [pi rad]
POINTS = 181  # along each side of a map
RADII = (0.5, 12.0)  # turning radii of the person in the figure, in [m]
# Behind a legend, so that a white line is visible.
GREY = {"frameon": True, "facecolor": "0.82"}


def draw_bound(
    game: CarGame, table: ValueTable, capture: float, path: AnyPath
) -> None:
    """Draw slices of the value function in the pursuer's frame.

    Each slice has one angle between the directions of motion; the evader is
    at (x, y), and an arrow shows its direction of motion. The barrier is
    that of a capture distance, in [m].
    """
    far = min(table.grid.edge, 1.4 * table.reach(capture))
    side = np.linspace(-far, far, POINTS)
    figure, axes = panels(
        ["abcd"], 12.6, [2.3], legend=3, gaps=(0.35, 0.8), sharey=True
    )
    for ax, share in zip(axes.values(), HEADINGS, strict=True):
        image = _draw_slice(ax, game, table, capture, share * pi, side)
        ax.set_xlabel("ahead of the pursuer [m]")
    axes["a"].set_ylabel("to its left [m]")
    label = "closest approach with\noptimal play [m]"
    figure.colorbar(image, ax=list(axes.values()), label=label)
    further = {
        name: Line2D([], [], color=colour, lw=2.5)
        for colour, name in (
            ("w", "boundary of the initial poses with certain capture"),
            (PURSUER, "pursuer's direction"),
            (EVADER, "evader's direction, at any position"),
        )
    }
    legend_below(figure, [axes["a"]], further, ncols=2, **GREY)
    save(figure, path)


def _draw_slice(
    ax: Any,
    game: CarGame,
    table: ValueTable,
    capture: float,
    theta: float,
    side: Array,
) -> Any:
    """Draw the slice of an angle theta [rad]; return its image."""
    x, y = np.meshgrid(side, side)
    values = table.value(np.stack([x, y, np.full_like(x, theta)], axis=-1))
    values[np.hypot(x, y) > table.grid.edge] = np.nan
    far = float(side[-1])
    look = {"cmap": "cividis", "rasterized": True}
    image = ax.pcolormesh(x, y, values, vmin=0.0, vmax=far, **look)
    ax.contour(x, y, values, [capture], colors="w", linewidths=1.5)
    if game.identical:
        unit = game.unit
        points, _ = barrier_slice(capture / unit, theta)
        label = "the same boundary, computed directly"
        ax.plot(*(unit * points.T), ":", color=THEORY, lw=1.5, label=label)
    circle = ring(0.0, 0.0, capture)[:, 0].T
    label = f"capture distance {capture:.3g} m"
    ax.plot(*circle, color=PURSUER, lw=0.8, label=label)
    _arrow(ax, 0.0, 0.0, 0.2 * far, PURSUER)
    _arrow(ax, 0.75 * far, theta, 0.2 * far, EVADER)
    ax.set_title(f"directions {np.rad2deg(theta):.0f}° apart")
    ax.set_aspect("equal")
    ax.grid(visible=False)
    return image


def _arrow(
    ax: Any, y: float, heading: float, length: float, colour: str
) -> None:
    tip = length * np.cos(heading), y + length * np.sin(heading)
    look = {"color": colour, "width": 2.0, "headwidth": 8.0}
    ax.annotate("", tip, (0.0, y), arrowprops=look)


def draw_chauffeur(
    game: ChauffeurGame,
    table: ValueTable,
    capture: float,
    path: AnyPath,
) -> None:
    """Draw the guaranteed distance around a person, and its requirement.

    The capture distance is that of contact, in [m].
    """
    figure, axes = panels(["ab"], 9.6, [3.2], legend=1, gaps=(1.4, 0.8))
    _draw_map(axes["a"], table, capture)
    _draw_agility(axes["b"], game.pursuer_speed, capture)
    own = game.evader_speed, game.turning_radius
    axes["b"].plot(*own, "o", c=EVADER)
    further = {
        "contact can be forced": Line2D([], [], color="w", lw=2.0),
        "this robot and person": Line2D(
            [], [], color=EVADER, marker="o", ls=""
        ),
    }
    legend_below(figure, [], further, ncols=2, **GREY)
    save(figure, path)


def _draw_agility(ax: Any, pursuer_speed: float, capture: float) -> None:
    """Draw the distance that a speed guarantees, over turning radii."""
    speeds = np.linspace(0.05, 0.99, 95) * pursuer_speed
    radii = np.linspace(*RADII, 116)
    ratios = np.array([guaranteed_distance(w / pursuer_speed) for w in speeds])
    distances = radii[:, None] * ratios
    levels = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0]
    lines = ax.contour(
        speeds, radii, distances, levels, colors="0.5", linewidths=0.8
    )
    ax.clabel(lines, fmt="%g m", fontsize=8)
    ax.contour(
        speeds, radii, distances, [capture], colors=PURSUER, linewidths=2.0
    )
    ax.set_xlabel("speed of the robot in every direction [m/s]")
    ax.set_ylabel("turning radius of the person [m]")
    title = f"distance guaranteed against {pursuer_speed:g} m/s"
    ax.set_title(f"{title}; red {capture:g} m")


def _draw_map(ax: Any, table: ValueTable, capture: float) -> None:
    """Draw the guaranteed distance around the person."""
    x, y, _ = table.grid.axes()
    inside = table.values[:, :, 0] < 0.97 * table.values.max()
    ahead = np.linspace(x[0], 1.5 * x[inside.any(axis=1)].max(), POINTS)
    left = np.linspace(-y[-1], y[-1], POINTS)
    poses = np.stack(np.broadcast_arrays(ahead[:, None], left, 0.0), axis=-1)
    values = table.value(poses)
    look = {"cmap": "cividis", "rasterized": True}
    image = ax.pcolormesh(left, ahead, values, vmin=0.0, **look)
    ax.figure.colorbar(image, ax=ax, label="guaranteed distance [m]")
    ax.contour(left, ahead, values, [capture], colors="w", linewidths=2.0)
    look = {"color": PURSUER, "width": 2.0, "headwidth": 8.0}
    ax.annotate("", (0.0, 0.3 * ahead[-1]), (0.0, 0.0), arrowprops=look)
    ax.invert_xaxis()  # left is to the left
    ax.set(aspect="equal", title="where a robot is safe")
    ax.grid(visible=False)
    ax.set_xlabel("to the person's left [m]")
    ax.set_ylabel("ahead of the person [m]")
