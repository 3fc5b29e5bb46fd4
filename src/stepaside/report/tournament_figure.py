"""Figures of a tournament: closest approach over floor used, worst games."""

from collections.abc import Mapping, Sequence
from math import ceil
from typing import Any, Protocol

from ..arena import Room
from ..core.poses import Array
from .figure_style import EVADER, PURSUER, plt, save
from .room_figure import draw_body, room_patches

MARKS = "osD^vP*X"
COLUMNS = 3


class GamePaths(Protocol):
    """Recorded poses (x [m], y [m], theta [rad]) of two players."""

    @property
    def pursuer(self) -> Array:
        """Of the pursuer. Shape (n, 3)."""

    @property
    def evader(self) -> Array:
        """Of the evader. Shape (n, 3)."""


def draw_front(rows: Sequence[Mapping[str, Any]], path: str) -> None:
    """Draw closest approach over floor used, with a mark for each pairing.

    Args:
        rows: Rows of the tournament.
        path: File to write; its suffix gives the format.
    """
    figure, ax = plt.subplots(figsize=(5.6, 4.0))
    pursuers = list(dict.fromkeys(row["pursuer"] for row in rows))
    evaders = list(dict.fromkeys(row["evader"] for row in rows))
    for row in rows:
        n = evaders.index(row["evader"])
        ax.errorbar(
            row["floor_used_m2"],
            row["mean_closest_m"],
            xerr=row["floor_used_pm_m2"],
            yerr=row["mean_closest_pm_m"],
            color=f"C{n}",
            marker=MARKS[pursuers.index(row["pursuer"]) % len(MARKS)],
            markersize=7,
            linestyle="",
            label=f"{row['evader']} against {row['pursuer']}"
            if len(pursuers) > 1
            else row["evader"],
        )
        ax.annotate(
            f" {100 * row['survived']:.0f} %",
            (row["floor_used_m2"], row["mean_closest_m"]),
            xytext=(5, 4),
            textcoords="offset points",
            fontsize=8,
        )
    ax.set_xlabel("floor used [m²], mean and 95 % interval")
    ax.set_ylabel("closest approach [m], mean and 95 % interval")
    ax.set_title("percentage beside each mark: games survived")
    ax.set_xlim(left=0.0)
    ax.set_ylim(bottom=0.0)
    ax.legend(fontsize=8)
    save(figure, path)


def draw_worst(
    games: Sequence[tuple[str, Room, GamePaths]], path: str
) -> None:
    """Draw the paths of whole games in their rooms.

    Args:
        games: Title, room and recorded poses of each game.
        path: File to write; its suffix gives the format.
    """
    columns = min(COLUMNS, len(games))
    lines = ceil(len(games) / columns)
    figure, axes = plt.subplots(
        lines,
        columns,
        figsize=(3.4 * columns, 3.5 * lines),
        squeeze=False,
    )
    for ax in axes.flat[len(games) :]:
        ax.axis("off")
    for ax, (title, room, track) in zip(axes.flat, games, strict=False):
        for patch in room_patches(room):
            ax.add_patch(patch)
        for way, colour, name in (
            (track.pursuer, PURSUER, "pursuer"),
            (track.evader, EVADER, "evader"),
        ):
            ax.plot(way[:, 0], way[:, 1], color=colour, lw=1.0)
            ax.plot(*way[0, :2], "o", color=colour, ms=4)
            draw_body(ax, way[-1], colour, name)
        ax.set_title(title, fontsize=8)
        ax.set_aspect("equal")
        ax.set_xlabel("x [m]")
    for ax in axes[:, 0]:
        ax.set_ylabel("y [m]")
    save(figure, path)
