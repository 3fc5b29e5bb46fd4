"""Plots over time, with the theory's values."""

from collections.abc import Sequence

import numpy as np
import viser
from viser import uplot

from ...core.poses import Array
from ..figure_style import EVADER, PURSUER, THEORY
from ..palette import on_both_floors
from .live_session import LiveSession

PADDING = (12, 12, 0, 0)  # for the last tick labels, in [pixels]
LAST = 1e6  # order of elements below all others
NO_SIGNAL = "none"
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


class SignalPlot:
    """Plot of one recorded quantity, which a viewer chooses."""

    def __init__(self, gui: viser.GuiApi, labels: Sequence[str]) -> None:
        """Add the choice and an empty plot to a page.

        Args:
            gui: Controls of the page.
            labels: Quantities with their units.
        """
        self._gui = gui
        self._choice = gui.add_dropdown(
            "Signal", (NO_SIGNAL, *labels), order=LAST + 2
        )
        self._plot: viser.GuiUplotHandle | None = None
        self._shown = NO_SIGNAL

    @property
    def label(self) -> str:
        """The quantity that is chosen; empty if there is none."""
        return "" if self._choice.value == NO_SIGNAL else self._choice.value

    def offer(self, labels: Sequence[str]) -> None:
        """Offer other quantities."""
        options = (NO_SIGNAL, *labels)
        if tuple(self._choice.options) != options:
            self._choice.options = options

    def show(self, times: Array, values: Array) -> None:
        """Show the chosen quantity.

        Args:
            times: In [s]. Shape (n,).
            values: At these times. Shape (n,).
        """
        data = plot_data(times, values, None)
        if self._plot is not None and self._shown == self.label:
            self._plot.data = data
            return
        self.hide()
        self._shown, title = self.label, self.label
        self._plot = add_plot(
            self._gui, title, "signal", EVADER, data, order=LAST + 3
        )

    def hide(self) -> None:
        """Remove the plot."""
        if self._plot is not None:
            self._plot.remove()
            self._plot = None


class Plots:
    """Plots of a live game: distance, angle of a duel, and a signal."""

    def __init__(self, gui: viser.GuiApi, *, with_angle: bool = True) -> None:
        """Add empty plots to a page.

        Args:
            gui: Controls of the page.
            with_angle: Whether to plot the angle between the headings.
        """
        self._gui = gui
        empty = plot_data(np.zeros(1), np.zeros(1), None)
        numbers = range(2 if with_angle else 1)
        self._plots = [self._add(number, empty) for number in numbers]
        self._signal = SignalPlot(gui, ())

    def _add(self, number: int, data: Data) -> viser.GuiUplotHandle:
        """Add one of the two plots below all other elements."""
        label, colour = (("distance", PURSUER), ("angle", EVADER))[number]
        title, order = TITLES[number], LAST + number
        return add_plot(self._gui, title, label, colour, data, order=order)

    def show(self, session: LiveSession) -> None:
        """Show the history of a session."""
        with session.lock:
            trail = session.trail
            rows = np.array(trail.history).reshape(-1, 3)
            labels, signals = trail.labels, [*trail.signals]
        if len(rows) < 2:
            return
        theory = session.theory or (None, None)
        for number, plot in enumerate(self._plots):
            level = theory[number]
            data = plot_data(rows[:, 0], rows[:, number + 1], level)
            if len(data) == len(plot.data):
                plot.data = data
            else:  # the number of lines of a plot is fixed
                plot.remove()
                self._plots[number] = self._add(number, data)
        self._signal.offer(labels)
        if self._signal.label in labels and len(signals) == len(rows):
            column = labels.index(self._signal.label)
            values = np.array([row[column] for row in signals], dtype=float)
            self._signal.show(rows[:, 0], values)
        else:
            self._signal.hide()
