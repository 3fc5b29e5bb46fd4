"""Soles and headings in top views."""

from typing import Any

import numpy as np
from matplotlib.patches import Polygon

from ..core.poses import Array
from ..planning import Foot, SoleRectangle
from ..planning.support_polygon import sole_corners


def draw_soles(
    axes: Any, landings: Array, sole: SoleRectangle, colour: str, **style: Any
) -> None:
    """Draw footsteps as outlines of the soles.

    Args:
        axes: Matplotlib axes.
        landings: Rows (time [s], side, x [m], y [m], theta [rad]).
        sole: Shape of a left sole.
        colour: Of the outlines.
        style: Further arguments of the patches.
    """
    for _, side, *pose in landings.tolist():
        corners = sole_corners(np.array(pose), Foot(int(side)), sole)
        axes.add_patch(
            Polygon(corners, closed=True, fill=False, ec=colour, **style)
        )


def draw_heading(axes: Any, pose: Array, colour: str, size: float) -> None:
    """Draw a player as a wedge that points along its heading.

    Args:
        axes: Matplotlib axes.
        pose: (x [m], y [m], theta [rad]). Shape (3,).
        colour: Fill.
        size: Length, in [m].
    """
    shape = size * np.array(
        [[0.6, 0.0], [-0.4, 0.35], [-0.2, 0.0], [-0.4, -0.35]]
    )
    x, y, theta = pose.tolist()
    c, s = np.cos(theta), np.sin(theta)
    corners = shape @ np.array([[c, s], [-s, c]]) + (x, y)
    axes.add_patch(
        Polygon(corners, closed=True, fc=colour, ec="white", lw=0.6, zorder=5)
    )
