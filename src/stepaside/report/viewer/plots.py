"""Plots of distance and orientation beside theory."""

import numpy as np
import viser
from viser import uplot

from ...core.poses import Array
from ..figure_style import EVADER, PURSUER, THEORY
from ..palette import seen_by_all
from .live_session import LiveSession

# Room above and to the right of a plot for its last marks, in [pixels].
PADDING = (12, 12, 0, 0)
LAST = 1e6  # order of what stands below everything else
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
    """Add a plot over time, beside what theory says if it says something.

    Args:
        gui: Of the page.
        title: Says what is shown, and its unit.
        label: Of what is shown.
        colour: Of its line.
        data: As of :func:`plot_data`.
        order: Of the plot on its panel; by default below what is there.
    """
    series = (
        uplot.Series(label="time [s]"),
        uplot.Series(label=label, stroke=seen_by_all(colour), width=2),
        uplot.Series(label="theory", stroke=seen_by_all(THEORY), dash=(5, 5)),
    )
    return gui.add_uplot(
        data,
        series[: len(data)],
        title=title,
        height=125,
        padding=PADDING,
        order=order,
        # Seconds of the run, which are no date.
        scales={"x": uplot.Scale(time=False)},
    )


def plot_data(times: Array, values: Array, level: float | None) -> Data:
    """Return what a plot shows, without NaN: uPlot draws no series with one.

    Args:
        times: In [s]. Shape (n,).
        values: At these times; samples that are not finite are left out.
            Shape (n,).
        level: Of theory; None or NaN if there is none.

    Returns:
        Times and values, and the level at each time if there is one.
    """
    known = np.isfinite(times) & np.isfinite(values)
    data = times[known], values[known]
    if level is None or not np.isfinite(level):
        return data
    return *data, np.full(len(data[0]), level)


class Plots:
    """Two plots of a live duel."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Add empty plots to a page."""
        self._gui = gui
        empty = plot_data(np.zeros(1), np.zeros(1), None)
        self._plots = [self._add(number, empty) for number in (0, 1)]

    def _add(self, number: int, data: Data) -> viser.GuiUplotHandle:
        """Add one of the two below all else that is watched."""
        label, colour = (("distance", PURSUER), ("angle", EVADER))[number]
        title, order = TITLES[number], LAST + number
        return add_plot(self._gui, title, label, colour, data, order=order)

    def show(self, session: LiveSession) -> None:
        """Show what a session has gone through."""
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
            else:  # theory came or went, and its line with it
                plot.remove()
                self._plots[number] = self._add(number, data)
