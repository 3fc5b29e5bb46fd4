"""Plots of distance and angle over time, with the theory's values."""

import numpy as np
import viser
from viser import uplot

from ...core.poses import Array
from ..figure_style import EVADER, PURSUER, THEORY
from ..palette import on_both_floors
from .live_session import LiveSession

PADDING = (12, 12, 0, 0)  # for the last tick labels, in [pixels]
LAST = 1e6  # order of elements below all others
TITLES = ("Distance [m]", "Angle between the headings [deg]")
Data = tuple[Array, ...]


def add_plot(
    gui: viser.GuiApi,
    title: str,
    label: str,
    colour: str,
    data: Data,
    *,
    order: float | None = None,
) -> viser.GuiUplotHandle:
    """Add a plot of a quantity over time.

    Args:
        gui: Controls of the page.
        title: Quantity with its unit.
        label: Label of the line.
        colour: Colour of the line.
        data: As returned by :func:`plot_data`.
        order: Position on its panel; by default below existing elements.

    Returns:
        Handle of the plot.
    """
    series = (
        uplot.Series(label="time [s]"),
        uplot.Series(label=label, stroke=on_both_floors(colour), width=2),
        uplot.Series(
            label="theory", stroke=on_both_floors(THEORY), dash=(5, 5)
        ),
    )
    return gui.add_uplot(
        data,
        series[: len(data)],
        title=title,
        height=125,
        padding=PADDING,
        order=order,
        # uPlot takes seconds for dates by default.
        scales={"x": uplot.Scale(time=False)},
    )


def plot_data(times: Array, values: Array, level: float | None) -> Data:
    """Return the data of a plot, without NaN, which uPlot cannot draw.

    Args:
        times: In [s]. Shape (n,).
        values: At these times; NaN and inf are left out. Shape (n,).
        level: Value of the theory; None or NaN if there is none.

    Returns:
        Times, values and, if there is one, the level at each time.
    """
    known = np.isfinite(times) & np.isfinite(values)
    data = times[known], values[known]
    if level is None or not np.isfinite(level):
        return data
    return *data, np.full(len(data[0]), level)


class Plots:
    """Plots of distance and angle of a live duel."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Add empty plots to a page."""
        self._gui = gui
        empty = plot_data(np.zeros(1), np.zeros(1), None)
        self._plots = [self._add(number, empty) for number in (0, 1)]

    def _add(self, number: int, data: Data) -> viser.GuiUplotHandle:
        """Add one of the two plots below all other elements."""
        label, colour = (("distance", PURSUER), ("angle", EVADER))[number]
        title, order = TITLES[number], LAST + number
        return add_plot(self._gui, title, label, colour, data, order=order)

    def show(self, session: LiveSession) -> None:
        """Show the history of a session."""
        with session.lock:
            rows = np.array(session.trail.history).reshape(-1, 3)
        if len(rows) < 2:
            return
        theory = session.theory or (None, None)
        for number, level in enumerate(theory):
            plot = self._plots[number]
            data = plot_data(rows[:, 0], rows[:, number + 1], level)
            if len(data) == len(plot.data):
                plot.data = data
            else:  # the number of lines of a plot is fixed
                plot.remove()
                self._plots[number] = self._add(number, data)
