"""Image of a game from above."""

from collections.abc import Sequence
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
    poses: Sequence[Pose],
    paths: Sequence[Any],
    colours: Sequence[str],
) -> NDArray[np.uint8]:
    """Return an image of the players and the room.

    Args:
        room: The room.
        poses: Poses of the players in the room.
        paths: Their positions so far, in [m]. Each of shape (n, 2).
        colours: Colour of each player.

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
        if solid.hull.radius > 0.0:
            shape: Any = Circle(solid.centre, solid.hull.radius)
        else:
            shape = Outline(solid.outline, closed=True)
        shape.set_facecolor("0.7")
        axes.add_patch(shape)
    for pose, path, colour in zip(poses, paths, colours, strict=True):
        if len(path):
            axes.plot(*np.asarray(path).T, color=colour, lw=1.0)
        axes.add_patch(Circle((pose.x, pose.y), BODY, color=colour, alpha=0.5))
        nose = pose.x + BODY * cos(pose.theta), pose.y + BODY * sin(pose.theta)
        axes.plot([pose.x, nose[0]], [pose.y, nose[1]], color="k", lw=2.0)
    middle = np.mean([pose[:2] for pose in poses], axis=0)
    apart = np.ptp([pose[:2] for pose in poses], axis=0).max()
    reach = max(REACH, 0.5 * apart + 2.0 * BODY)
    if room.width is not None and room.depth is not None:
        middle, reach = np.zeros(2), 0.55 * max(room.width, room.depth)
    axes.set_xlim(middle[0] - reach, middle[0] + reach)
    axes.set_ylim(middle[1] - reach, middle[1] + reach)
    canvas.draw()
    image: NDArray[np.uint8] = np.asarray(canvas.buffer_rgba())
    return image[..., :3].copy()


class ImagePage:
    """Page in the browser that shows the newest image.

    Attributes:
        address: Address of the page.
    """

    def __init__(self, port: int = 8080) -> None:
        """Serve the page at the first free port.

        Args:
            port: First port to try.
        """
        from ..report.viewer.page_server import open_server

        self._server = open_server(port)
        self._handle: Any = None

    def show(self, image: NDArray[np.uint8], info: dict[str, Any]) -> None:
        """Replace the image.

        Args:
            image: Shape (height, width, 3).
            info: Values below it.
        """
        text = ", ".join(
            f"{key} {value:.2f}" if isinstance(value, float) else f"{value}"
            for key, value in info.items()
        )
        gui = self._server.gui
        if self._handle is None:
            self._handle = gui.add_image(image), gui.add_markdown(text)
        else:
            self._handle[0].image, self._handle[1].content = image, text
