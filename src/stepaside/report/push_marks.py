"""Pushes in figures: from above, and over time."""

from typing import Any

import numpy as np

from ..core.poses import Array
from ..games.run import Run
from .figure_style import PUSHED

LENGTH = 0.2  # of an arrow, in [m] per [N s]


def draw_pushes(axes: Any, pushes: Array | None) -> None:
    """Draw pushes from above, as arrows that end where they were felt.

    Args:
        axes: Matplotlib axes.
        pushes: Rows of a track, if it has any. Shape (j, 6).
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
        # Arrows do not count when axes are fitted to what they show.
        axes.plot(*start, ".", color=PUSHED, ms=2)


def mark_pushes(axes: Any, run: Run) -> None:
    """Mark the times of all pushes in a plot over time."""
    times = [
        time
        for track in run.tracks.values()
        if track.pushes is not None
        for time in track.pushes[:, 0].tolist()
    ]
    for number, time in enumerate(times):
        label = None if number else "push"
        axes.axvline(time, color=PUSHED, ls=":", lw=1.0, label=label)
