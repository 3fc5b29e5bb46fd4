"""Plots over time, with the theory's values."""

import numpy as np
import viser
from viser import uplot

from ...core.poses import Array
from ..palette import PALETTES, on_both_floors
from .live_session import LiveSession

PADDING = (12, 12, 0, 0)  # for the last tick labels, in [pixels]
LAST = 1e6  # order of elements below all others
NO_SIGNAL = "none"
DISTANCE, ANGLE = "Distance [m]", "Angle between the headings [deg]"
LIGHT = PALETTES["light"]
PURSUER, EVADER = LIGHT.pursuer, LIGHT.evader
Data = tuple[Array, ...]


def add_plot(
    gui: viser.GuiApi, title: str, colour: str, data: Data, order: float
) -> viser.GuiUplotHandle:
    """Add a plot of a quantity over time.

    Args:
        gui: Controls of the page.
        title: Quantity with its unit.
        colour: Colour of the line.
        data: As returned by :func:`plot_data`.
        order: Position on its panel.
    """
    dash = on_both_floors(LIGHT.theory)
    series = (
        uplot.Series(label="time [s]"),
        uplot.Series(label=title, stroke=on_both_floors(colour), width=2),
        uplot.Series(label="theory", stroke=dash, dash=(5, 5)),
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
    """Plots of a live game: distance, angle of a duel, and a signal."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Add empty plots to a page, below all other elements."""
        self._gui = gui
        self._plots: dict[str, viser.GuiUplotHandle] = {}
        self._choice = gui.add_dropdown("Signal", (NO_SIGNAL,), order=LAST + 2)

    def show(self, session: LiveSession) -> None:
        """Show the history of a session."""
        with session.lock:
            history = session.history
            rows = np.array(history.history).reshape(-1, 3)
            labels, signals = history.labels, [*history.signals]
        options = (NO_SIGNAL, *labels)
        if tuple(self._choice.options) != options:
            self._choice.options = options
        if len(rows) < 2:
            return
        theory = session.theory or (None, None, None)
        shown = {
            DISTANCE: (rows[:, 1], theory[1], PURSUER),
            ANGLE: (rows[:, 2], theory[2], EVADER),
        }
        chosen = self._choice.value
        if chosen in labels and len(signals) == len(rows):
            values = np.array(signals, dtype=float)[:, labels.index(chosen)]
            shown[chosen] = values, None, EVADER
        for number, (title, (values, level, colour)) in enumerate(
            shown.items()
        ):
            data = plot_data(rows[:, 0], values, level)
            plot = self._plots.get(title)
            if plot is not None and len(plot.data) == len(data):
                plot.data = data
                continue
            if plot is not None:  # the number of lines of a plot is fixed
                plot.remove()
                del self._plots[title]
            if len(data[0]):
                order = LAST + (3 if number == 2 else number)
                self._plots[title] = add_plot(
                    self._gui, title, colour, data, order
                )
        for title in self._plots.keys() - shown.keys():
            self._plots.pop(title).remove()
