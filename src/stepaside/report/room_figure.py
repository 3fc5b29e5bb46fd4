"""Figure of a room, and its walls and obstacles in other figures."""

from collections.abc import Iterable
from math import cos, sin
from typing import Any

import numpy as np
from matplotlib.patches import Circle, Patch
from matplotlib.patches import Polygon as Outline

from ..arena import BODY_RADIUS, Obstacle, Room
from ..core.poses import Array
from ..games.run import Run
from .figure_sizes import sheet
from .figure_style import (
    EVADER,
    PURSUER,
    THEORY,
    colours_of,
    mark_level,
    plt,
    save,
)

MAX_SAMPLES = 1500  # of a curve, approximately
SOLID, MOVING = "#8a8f98", "#99704a"


def solid_patches(solids: Iterable[Obstacle], **look: Any) -> list[Patch]:
    """Return walls and obstacles as patches of Matplotlib.

    Args:
        solids: In the frame of the axes, in [m].
        look: Further arguments of the patches.
    """
    look = {"facecolor": SOLID, "edgecolor": "none", "zorder": 1} | look
    return [Outline(solid.outline, closed=True, **look) for solid in solids]


def room_patches(room: Room, time: float = 0.0) -> list[Patch]:
    """Return a room as patches, with moving boxes outlined at their ends.

    Args:
        room: The room.
        time: Time at which moving boxes are drawn, in [s].
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


def has_obstacles(run: Run) -> bool:
    """Return whether a run has walls or obstacles."""
    plan = run.plan
    return plan is not None and bool(plan.solids or plan.moving)


def clearance_of(room: Room, places: Array, times: Array) -> Array:
    """Return the distance to the nearest wall or obstacle, in [m].

    Args:
        room: The room.
        places: Positions (x, y) in the room, in [m]. Shape (n, 2).
        times: Time at each position, in [s]. Shape (n,).

    Returns:
        Signed distances, negative inside. Shape (n,).
    """
    found = room.clearance(places)
    for mover in room.moving:
        moved = [
            float(mover.at(time).clearance([place])[0])
            for place, time in zip(places, times.tolist(), strict=True)
        ]
        found = np.minimum(found, moved)
    return found


def draw_clearance(axes: Any, run: Run) -> None:
    """Draw each player's clearance over time.

    Args:
        axes: Matplotlib axes.
        run: The run, in a room.
    """
    assert run.plan is not None
    every = slice(None, None, max(1, len(run.times) // MAX_SAMPLES))
    times = run.times[every]
    for name, colour in colours_of(run.players, run.identities).items():
        places = run.tracks[name].unicycle[every, :2]
        clearance = clearance_of(run.plan, places, times)
        axes.plot(times, clearance, color=colour, lw=1.4, label=name)
    mark_level(
        axes,
        BODY_RADIUS,
        f"body radius\n{BODY_RADIUS:.3g} m",
        THEORY,
        va="top",
    )
    axes.set(xlabel="time [s]", ylabel="clearance [m]")
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    axes.margins(x=0.0)
    title = "distance to the nearest wall or obstacle"
    if not sheet().narrow:
        title += ", from each player's reference point"
    axes.set_title(title, pad=18)
    axes.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 0.965))


def draw_room(room: Room, path: str) -> None:
    """Write a figure of a room with the initial poses.

    Args:
        room: The room.
        path: File to write; its suffix gives the format.
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
    """Draw a body as a disc with a line along its heading.

    Args:
        ax: Matplotlib axes.
        pose: (x [m], y [m], theta [rad]).
        colour: Of the body.
        name: Label in the legend.
    """
    x, y, theta = pose
    ax.add_patch(
        Circle((x, y), BODY_RADIUS, facecolor=colour, alpha=0.35, lw=0)
    )
    nose = (x + BODY_RADIUS * cos(theta), y + BODY_RADIUS * sin(theta))
    ax.plot((x, nose[0]), (y, nose[1]), color=colour, lw=2, label=name)
