"""Plots over time, with the theory's values."""

import numpy as np
import viser
from viser import uplot

from ...core.poses import Array
from ..palette import PALETTES
from .live_session import LiveSession

PADDING = (12, 12, 0, 0)  # for the last tick labels, in [pixels]
LAST = 1e6  # order of elements below all others
LIGHT = PALETTES["light"]
COLOURS = {
    "Distance [m]": LIGHT.pursuer,
    "Angle between the headings [deg]": LIGHT.evader,
}


class Plots:
    """Plots of a live game: distance, and the angle of a duel."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Start without plots; they come below all other elements."""
        self._gui = gui
        self._plots: dict[str, viser.GuiUplotHandle] = {}

    def show(self, session: LiveSession) -> None:
        """Show the history of a session."""
        with session.lock:
            rows = np.array(session.history.history).reshape(-1, 3)
        if len(rows) < 2:
            return
        theory = session.theory or (None, None, None)
        for column, title in enumerate(COLOURS, 1):
            # uPlot cannot draw NaN.
            data = tuple(rows[np.isfinite(rows[:, column])][:, [0, column]].T)
            level = theory[column]
            if level is not None:
                data = (*data, np.full(len(data[0]), level))
            plot = self._plots.get(title)
            if plot is not None and len(plot.data) == len(data):
                plot.data = data
                continue
            if plot is not None:  # the number of lines of a plot is fixed
                plot.remove()
                del self._plots[title]
            if len(data[0]):
                self._plots[title] = self._add(title, data, column)

    def _add(
        self, title: str, data: tuple[Array, ...], number: int
    ) -> viser.GuiUplotHandle:
        """Add a plot: times, values, and the theory's value if it is known."""
        series = (
            uplot.Series(label="time [s]"),
            uplot.Series(label=title, stroke=COLOURS[title], width=2),
            uplot.Series(label="theory", stroke=LIGHT.theory, dash=(5, 5)),
        )
        return self._gui.add_uplot(
            data,
            series[: len(data)],
            title=title,
            height=125,
            padding=PADDING,
            order=LAST + number,
            # uPlot takes seconds for dates by default.
            scales={"x": uplot.Scale(time=False)},
        )
