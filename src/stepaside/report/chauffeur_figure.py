"""Figure of a chauffeur's game: where to start, and how agile to be."""

from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from ..theory.value import ChauffeurGame, ValueTable
from ..theory.value.closed_forms import guaranteed_distance
from .figure_style import EVADER, PURSUER, add_common_legend, new_figure, save

POINTS = 201  # along each side of the map
RADII = (0.5, 12.0)  # turning radii of the person in the figure, in [m]


def draw_chauffeur(
    game: ChauffeurGame,
    table: ValueTable,
    standing: ValueTable,
    capture: float,
    path: str,
) -> None:
    """Draw the guaranteed distance around a person, and its requirement.

    Args:
        game: The game.
        table: Table of the game.
        standing: Table of an evader that stands for its response time.
        capture: Contact distance, in [m].
        path: File to write; its suffix gives the format.
    """
    figure = new_figure(9.6, 4.4)
    around, agile = figure.subplots(1, 2)
    _draw_map(around, table, standing, capture)
    draw_agility(agile, game.pursuer_speed, capture)
    agile.plot(game.velocities.smallest, game.turning_radius, "o", c=EVADER)
    further = {
        "contact can be forced": Line2D([], [], color="w", lw=2.0),
        "a robot that stands must start": Line2D(
            [], [], color="w", lw=1.5, ls="--"
        ),
        "this robot and person": Line2D(
            [], [], color=EVADER, marker="o", ls=""
        ),
    }
    add_common_legend(
        figure, [], further, ncols=3, frameon=True, facecolor="0.82"
    )
    save(figure, path)


def draw_agility(ax: Any, pursuer_speed: float, capture: float) -> None:
    """Draw the distance that a speed guarantees, over turning radii.

    Args:
        ax: Matplotlib axes.
        pursuer_speed: Speed of the person, in [m/s].
        capture: Contact distance, whose line is drawn, in [m].
    """
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
    ax.set_title(
        f"distance guaranteed against {pursuer_speed:g} m/s; red {capture:g} m"
    )


def _draw_map(
    ax: Any, table: ValueTable, standing: ValueTable, capture: float
) -> None:
    """Draw the guaranteed distance around the person."""
    x, y, _ = table.grid.axes()
    inside = standing.values[:, :, 0] < 0.97 * standing.values.max()
    ahead = np.linspace(x[0], 1.5 * x[inside.any(axis=1)].max(), POINTS)
    left = np.linspace(-y[-1], y[-1], POINTS)
    poses = np.stack(np.broadcast_arrays(ahead[:, None], left, 0.0), axis=-1)
    values = table.value(poses)
    image = ax.pcolormesh(
        left, ahead, values, vmin=0.0, cmap="cividis", rasterized=True
    )
    ax.figure.colorbar(image, ax=ax, label="guaranteed distance [m]")
    ax.contour(left, ahead, values, [capture], colors="w", linewidths=2.0)
    stood = standing.value(poses)
    ax.contour(
        left, ahead, stood, [capture],
        colors="w", linewidths=1.5, linestyles="--",
    )  # fmt: skip
    ax.annotate(
        "", (0.0, 0.3 * ahead[-1]), (0.0, 0.0),
        arrowprops={"color": PURSUER, "width": 2.0, "headwidth": 8.0},
    )  # fmt: skip
    ax.invert_xaxis()  # left is to the left
    ax.set_aspect("equal")
    ax.grid(visible=False)
    ax.set_xlabel("to the person's left [m]")
    ax.set_ylabel("ahead of the person [m]")
    ax.set_title("where a robot is safe")
