"""Figure of a room, and solids for other figures."""

from collections.abc import Iterable
from typing import Any

from matplotlib.patches import Circle, Patch
from matplotlib.patches import Polygon as Outline

from ..rooms import BODY_RADIUS, Obstacle, Room
from .style import EVADER, PURSUER, plt, save

SOLID, MOVING = "#8a8f98", "#99704a"


def solid_patches(solids: Iterable[Obstacle], **look: Any) -> list[Patch]:
    """Solids as patches of matplotlib.

    Args:
        solids: In the frame of the axes, in [m].
        look: How to draw them.
    """
    look = {"facecolor": SOLID, "edgecolor": "none", "zorder": 1} | look
    return [Outline(solid.outline, closed=True, **look) for solid in solids]


def room_patches(room: Room, time: float = 0.0) -> list[Patch]:
    """All of a room as patches; what moves is outlined where it turns.

    Args:
        room: The room.
        time: At which what moves is where it is drawn, in [s].
    """
    return [
        *solid_patches(room.solids),
        *solid_patches(
            (box.at(time) for box in room.moving), facecolor=MOVING
        ),
        *solid_patches(
            (end for box in room.moving for end in box.ends),
            facecolor="none",
            edgecolor=MOVING,
            linestyle="--",
        ),
    ]


def draw_room(room: Room, path: str) -> None:
    """Write a figure of a room with its starts.

    Args:
        room: The room.
        path: File, of a format that its suffix tells.
    """
    figure, ax = plt.subplots(figsize=(4.0, 4.0))
    for patch in room_patches(room):
        ax.add_patch(patch)
    if room.starts is not None:
        for pose, colour, name in zip(
            room.starts,
            (PURSUER, EVADER),
            ("pursuer", "evader"),
            strict=True,
        ):
            draw_body(ax, pose, colour, name)
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)
    ax.autoscale_view()
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    save(figure, path)


def draw_body(ax: Any, pose: Any, colour: str, name: str = "") -> None:
    """Draw a body as a disc that looks somewhere."""
    from math import cos, sin

    x, y, theta = pose
    ax.add_patch(
        Circle((x, y), BODY_RADIUS, facecolor=colour, alpha=0.35, lw=0)
    )
    nose = (x + BODY_RADIUS * cos(theta), y + BODY_RADIUS * sin(theta))
    ax.plot((x, nose[0]), (y, nose[1]), color=colour, lw=2, label=name)
