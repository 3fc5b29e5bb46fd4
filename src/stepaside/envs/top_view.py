"""Image of a game from above."""

from collections.abc import Mapping
from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arena import Room
from ..core.poses import Pose

SIZE = 4.0, 4.0  # of the image, in inches
REACH = 2.0  # least half width of the view, in [m]
BODY = 0.2  # radius of a player, in [m]


def draw_top_view(
    room: Room,
    poses: Mapping[str, Pose],
    paths: Mapping[str, Any],
    colours: Mapping[str, str],
) -> NDArray[np.uint8]:
    """Return an image of the players and the room.

    Args:
        room: The room.
        poses: Pose of each player in the room, by name.
        paths: Its positions so far, in [m]. Each of shape (n, 2).
        colours: Its colour.

    Returns:
        Shape (400, 400, 3).
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle
    from matplotlib.patches import Polygon as Outline

    figure = Figure(figsize=SIZE, dpi=100)
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    for solid in room.solids:
        if solid.rounding > 0.0:
            shape: Any = Circle(solid.centre, solid.rounding)
        else:
            shape = Outline(solid.outline, closed=True)
        shape.set_facecolor("0.7")
        axes.add_patch(shape)
    for name, pose in poses.items():
        colour = colours[name]
        axes.plot(*np.array(paths[name]).T, color=colour, lw=1.0)
        axes.add_patch(Circle((pose.x, pose.y), BODY, color=colour, alpha=0.5))
        nose = pose.x + BODY * cos(pose.theta), pose.y + BODY * sin(pose.theta)
        axes.plot([pose.x, nose[0]], [pose.y, nose[1]], color="k", lw=2.0)
    places = np.array([pose[:2] for pose in poses.values()])
    middle, apart = places.mean(axis=0), np.ptp(places, axis=0).max()
    reach = max(REACH, 0.5 * apart + 2.0 * BODY)
    if room.width is not None and room.depth is not None:
        middle, reach = np.zeros(2), 0.55 * max(room.width, room.depth)
    axes.set_xlim(middle[0] - reach, middle[0] + reach)
    axes.set_ylim(middle[1] - reach, middle[1] + reach)
    canvas.draw()
    image: NDArray[np.uint8] = np.asarray(canvas.buffer_rgba())
    return image[..., :3].copy()
