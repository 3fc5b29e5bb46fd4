"""Figure of a duel in the manner of the paper's Fig. 5."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..games.settings import DuelSettings
from ..games.summary import (
    cycle_mean,
    distance_over_time,
    orientation_over_time,
)
from ..poses import Array
from .soles import draw_heading, draw_soles
from .style import COLOURS, THEORY, plt

SNAPSHOTS = 4


def draw_duel(
    arrays: Mapping[str, Array],
    summary: Mapping[str, Any],
    settings: DuelSettings,
    path: Path,
) -> None:
    """Write the figure of a duel.

    Args:
        arrays: Its record.
        summary: Its figures.
        settings: What decided it.
        path: File, of a format that its suffix tells.
    """
    figure = plt.figure(figsize=(11.0, 8.2))
    grid = figure.add_gridspec(3, 4, height_ratios=[1.0, 1.7, 1.1])
    _draw_snapshots(figure, grid, arrays)
    _draw_paths(figure.add_subplot(grid[1, :2]), arrays, settings)
    over_time = grid[1, 2:].subgridspec(2, 1)
    _draw_over_time(figure, over_time, arrays, summary, settings)
    _draw_balance(figure, grid, arrays, settings)
    figure.suptitle(
        f"Duel, seed {summary['seed']}: {summary['message']}", fontsize=11
    )
    figure.savefig(path)
    plt.close(figure)


def _draw_snapshots(
    figure: Any, grid: Any, arrays: Mapping[str, Array]
) -> None:
    """Top views at four times, with the path walked so far."""
    times = arrays["times_s"]
    every = np.concatenate(
        [arrays["pursuer_com"][:, :2], arrays["evader_com"][:, :2]]
    )
    low, high = every.min(axis=0) - 0.2, every.max(axis=0) + 0.2
    # Early on more happens: the times grow as squares.
    fractions = (np.arange(SNAPSHOTS) / (SNAPSHOTS - 1)) ** 2
    for column, time in enumerate(fractions * times[-1]):
        axes = figure.add_subplot(grid[0, column])
        index = min(int(np.searchsorted(times, time)), len(times) - 1)
        for name, colour in COLOURS.items():
            com = arrays[f"{name}_com"]
            axes.plot(*com[: index + 1, :2].T, color=colour, lw=1.2)
            torso = arrays[f"{name}_torso"][index]
            draw_heading(axes, torso, colour, 0.28)
        axes.set(
            xlim=(low[0], high[0]),
            ylim=(low[1], high[1]),
            aspect="equal",
            title=f"{times[index]:.1f} s",
            xlabel="x [m]",
        )
        if column == 0:
            axes.set_ylabel("y [m]")


def _draw_paths(
    axes: Any, arrays: Mapping[str, Array], settings: DuelSettings
) -> None:
    """Both CoM paths with every footstep."""
    for name, colour in COLOURS.items():
        landings = arrays[f"{name}_landings"]
        sole = settings.gait.sole
        draw_soles(axes, landings, sole, colour, alpha=0.3, lw=0.5)
        com = arrays[f"{name}_com"]
        axes.plot(*com[:, :2].T, color=colour, lw=1.3, label=f"{name}, CoM")
        axes.plot(*com[0, :2], "o", color=colour, ms=5)
        draw_heading(axes, arrays[f"{name}_torso"][-1], colour, 0.2)
    axes.set(
        xlabel="x [m]",
        ylabel="y [m]",
        aspect="equal",
        title="CoM paths, planned footsteps; ● start, ➤ end",
    )
    axes.legend(loc="center", fontsize=8)


def _draw_over_time(
    figure: Any,
    grid: Any,
    arrays: Mapping[str, Array],
    summary: Mapping[str, Any],
    settings: DuelSettings,
) -> None:
    """Distance and relative orientation, beside theory's values."""
    times, theory = arrays["times_s"], summary["theory"]
    period = 2.0 * settings.gait.step_duration
    panels = (
        (
            distance_over_time(arrays),
            theory["distance_m"],
            "distance [m]",
        ),
        (
            np.degrees(orientation_over_time(arrays)),
            theory["relative_orientation_deg"],
            "between headings [deg]",
        ),
    )
    first = None
    for row, (values, value, label) in enumerate(panels):
        axes = figure.add_subplot(grid[row, 0], sharex=first)
        first = first or axes
        axes.plot(times, values, color="#9a7fb8", lw=0.7)
        axes.plot(
            times, cycle_mean(values, times, period), color="#5b2a86", lw=1.6
        )
        if value is not None:
            axes.axhline(value, color=THEORY, ls="--", lw=1.0)
            axes.annotate(
                f"theory {value:.3g}",
                (1.0, value),
                xycoords=("axes fraction", "data"),
                ha="right",
                va="bottom",
                fontsize=8,
                color=THEORY,
            )
        if row == 0:
            safety = settings.strategy.safety_radius
            axes.axhline(safety, color=COLOURS["evader"], ls=":", lw=1.0)
            axes.annotate(
                "safety area",
                (0.0, safety),
                xycoords=("axes fraction", "data"),
                va="bottom",
                fontsize=8,
                color=COLOURS["evader"],
            )
        axes.set_ylabel(label)
    if first is not None:
        axes.set_xlabel("time [s]")


def _draw_balance(
    figure: Any,
    grid: Any,
    arrays: Mapping[str, Array],
    settings: DuelSettings,
) -> None:
    """CoM against ZMP for the last few steps."""
    times = arrays["times_s"]
    span = 6.0 * settings.gait.step_duration
    show = times >= times[-1] - span
    for column, (name, colour) in enumerate(COLOURS.items()):
        axes = figure.add_subplot(grid[2, 2 * column : 2 * column + 2])
        heading = float(arrays[f"{name}_torso"][show][:, 2].mean())
        left = np.array([-np.sin(heading), np.cos(heading)])
        origin = arrays[f"{name}_com_reference"][show].mean(axis=0)
        shift = arrays[f"{name}_com"][show, :2].mean(axis=0)
        for key, centre, style in (
            ("zmp", shift, {"color": "#b0b0b0", "lw": 0.8}),
            ("zmp_reference", origin, {"color": THEORY, "lw": 1.2}),
            ("com_reference", origin, {"color": "#8a5fbf", "lw": 1.6}),
            ("com", shift, {"color": colour, "lw": 1.6}),
        ):
            across = (arrays[f"{name}_{key}"][show, :2] - centre) @ left
            label = key.replace("_", " ").replace("zmp", "ZMP")
            axes.plot(
                times[show],
                1e3 * across,
                label=label.replace("com", "CoM"),
                **style,
            )
        axes.set(xlabel="time [s]", title=f"{name}: last steps")
        axes.set_ylabel("leftward [mm]")
        axes.legend(ncols=4, fontsize=7, loc="upper center")
        axes.margins(y=0.25)
