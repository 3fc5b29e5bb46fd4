"""Pushes in figures: arrows in top views, lines in plots over time."""

from typing import Any

import numpy as np

from ..core.poses import Array
from ..games.run import Run
from .figure_style import PUSHED

LENGTH = 0.2  # of an arrow, in [m] per [N s]


def draw_pushes(axes: Any, pushes: Array | None) -> None:
    """Draw pushes in a top view, as arrows that end where they act.

    Args:
        axes: Matplotlib axes.
        pushes: Rows (time [s], duration [s], x [m], y [m], impulse x and y
            [N s]); None for none. Shape (j, 6).
    """
    for _, _, x, y, *impulse in () if pushes is None else pushes.tolist():
        start = np.array([x, y]) - LENGTH * np.array(impulse)
        axes.annotate(
            "",
            xy=(x, y),
            xytext=start,
            arrowprops={"arrowstyle": "-|>", "color": PUSHED, "lw": 1.6},
            zorder=6,
        )
        # Annotations do not count for the limits of the axes; a dot does.
        axes.plot(*start, ".", color=PUSHED, ms=2)


def mark_pushes(axes: Any, run: Run) -> None:
    """Mark the times of all pushes of a run in a plot over time."""
    times = [
        time
        for track in run.tracks.values()
        if track.pushes is not None
        for time in track.pushes[:, 0].tolist()
    ]
    for number, time in enumerate(times):
        label = None if number else "push"
        axes.axvline(time, color=PUSHED, ls=":", lw=1.0, label=label)
