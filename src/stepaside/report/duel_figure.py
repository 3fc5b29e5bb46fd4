"""Figure of a duel in the manner of the paper's Fig. 5."""

from pathlib import Path
from typing import Any

import numpy as np

from ..games.circle import cycle_mean
from ..games.run import Run
from .inert import for_figure
from .soles import draw_heading, draw_soles
from .style import COLOURS, THEORY, plt, save

SNAPSHOTS = 4


def draw_duel(
    run: Run,
    path: Path,
) -> None:
    """Write the figure of a duel.

    Args:
        run: The duel.
        path: File, of a format that its suffix tells.
    """
    figure = plt.figure(figsize=(11.0, 8.2))
    grid = figure.add_gridspec(3, 4, height_ratios=[1.0, 1.7, 1.1])
    _draw_snapshots(figure, grid, run)
    _draw_paths(figure.add_subplot(grid[1, :2]), run)
    over_time = grid[1, 2:].subgridspec(2, 1)
    _draw_over_time(figure, over_time, run)
    walkers = [n for n, t in run.tracks.items() if t.zmp is not None]
    for name, place in zip(walkers, _places(grid, len(walkers)), strict=True):
        _draw_balance(figure.add_subplot(place), run, name)
    figure.suptitle(
        f"Duel, seed {run.settings.seed}: {for_figure(run.message)}",
        fontsize=11,
    )
    save(figure, path)


def _places(grid: Any, count: int) -> list[Any]:
    """Parts of the lowest row, for one robot or two."""
    if count == 1:
        return [grid[2, :]]
    return [grid[2, 0:2], grid[2, 2:4]][:count]


def _draw_snapshots(figure: Any, grid: Any, run: Run) -> None:
    """Top views at four times, with the path walked so far."""
    times = run.times
    every = np.concatenate([track.com[:, :2] for track in run.tracks.values()])
    low, high = every.min(axis=0) - 0.2, every.max(axis=0) + 0.2
    # Early on more happens: the times grow as squares.
    fractions = (np.arange(SNAPSHOTS) / (SNAPSHOTS - 1)) ** 2
    for column, time in enumerate(fractions * times[-1]):
        axes = figure.add_subplot(grid[0, column])
        index = min(int(np.searchsorted(times, time)), len(times) - 1)
        for name, colour in COLOURS.items():
            com = run.tracks[name].com
            axes.plot(*com[: index + 1, :2].T, color=colour, lw=1.2)
            torso = run.tracks[name].torso[index]
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


def _draw_paths(axes: Any, run: Run) -> None:
    """Both CoM paths with every footstep."""
    for name, colour in COLOURS.items():
        track = run.tracks[name]
        if track.landings is not None:
            sole = run.settings.gait.sole
            draw_soles(axes, track.landings, sole, colour, alpha=0.3, lw=0.5)
        com = track.com
        axes.plot(*com[:, :2].T, color=colour, lw=1.3, label=f"{name}, CoM")
        axes.plot(*com[0, :2], "o", color=colour, ms=5)
        draw_heading(axes, track.torso[-1], colour, 0.2)
    axes.set(
        xlabel="x [m]",
        ylabel="y [m]",
        aspect="equal",
        title="CoM paths, planned footsteps; ● start, ➤ end",
    )
    axes.legend(loc="center", fontsize=8)


def _draw_over_time(figure: Any, grid: Any, run: Run) -> None:
    """Distance and relative orientation, beside theory's values."""
    times, theory = run.times, run.summary.theory
    period = 2.0 * run.settings.gait.step_duration
    panels = (
        (run.distance, theory.distance_m, "distance [m]"),
        (
            run.orientation,
            theory.relative_orientation_deg,
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
            safety = run.settings.strategy.safety_radius
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


def _draw_balance(axes: Any, run: Run, name: str) -> None:
    """CoM against ZMP of one robot for the last few steps."""
    times, track = run.times, run.tracks[name]
    colour = COLOURS[name]
    span = 6.0 * run.settings.gait.step_duration
    show = times >= times[-1] - span
    heading = float(track.torso[show][:, 2].mean())
    left = np.array([-np.sin(heading), np.cos(heading)])
    assert track.com_reference is not None
    origin = track.com_reference[show].mean(axis=0)
    shift = track.com[show, :2].mean(axis=0)
    for label, points, centre, style in (
        ("ZMP", track.zmp, shift, {"color": "#b0b0b0", "lw": 0.8}),
        (
            "ZMP reference",
            track.zmp_reference,
            origin,
            {"color": THEORY, "lw": 1.2},
        ),
        (
            "CoM reference",
            track.com_reference,
            origin,
            {"color": "#8a5fbf", "lw": 1.6},
        ),
        ("CoM", track.com, shift, {"color": colour, "lw": 1.6}),
    ):
        assert points is not None
        across = (points[show, :2] - centre) @ left
        axes.plot(times[show], 1e3 * across, label=label, **style)
    axes.set(xlabel="time [s]", title=f"{name}: last steps")
    axes.set_ylabel("leftward [mm]")
    axes.legend(ncols=4, fontsize=7, loc="upper center")
    axes.margins(y=0.25)
