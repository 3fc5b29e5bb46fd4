"""Plots of distance and orientation beside theory."""

import numpy as np
import viser
from viser import uplot

from ...poses import Array
from ..palette import seen_by_all
from ..style import EVADER, PURSUER, THEORY
from .session import Session

# Room above and to the right of a plot for its last marks, in [pixels].
PADDING = (12, 12, 0, 0)


def add_plot(
    gui: viser.GuiApi,
    title: str,
    label: str,
    colour: str,
    data: tuple[Array, Array, Array],
) -> viser.GuiUplotHandle:
    """Add a plot over time beside what theory says.

    Args:
        gui: Of the page.
        title: Says what is shown, and its unit.
        label: Of what is shown.
        colour: Of its line.
        data: Times in [s], values, and the values of theory; shape (n,) each.
    """
    return gui.add_uplot(
        data,
        (
            uplot.Series(label="time [s]"),
            uplot.Series(label=label, stroke=seen_by_all(colour), width=2),
            uplot.Series(
                label="theory", stroke=seen_by_all(THEORY), dash=(5, 5)
            ),
        ),
        title=title,
        height=125,
        padding=PADDING,
        # Seconds of the run, which are no date.
        scales={"x": uplot.Scale(time=False)},
    )


class Plots:
    """Two plots of a live duel."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Add empty plots to a page."""
        empty = (np.zeros(1), np.zeros(1), np.zeros(1))
        self._plots = [
            add_plot(gui, title, label, colour, empty)
            for title, label, colour in (
                ("Distance [m]", "distance", PURSUER),
                ("Angle between the headings [deg]", "angle", EVADER),
            )
        ]

    def show(self, session: Session) -> None:
        """Show what a session has gone through."""
        with session.lock:
            rows = np.array(session.trail.history).reshape(-1, 3)
        if len(rows) < 2:
            return
        theory = session.theory or (np.nan, np.nan)
        for column, plot in enumerate(self._plots, start=1):
            level = np.full(len(rows), theory[column - 1])
            plot.data = (rows[:, 0], rows[:, column], level)
