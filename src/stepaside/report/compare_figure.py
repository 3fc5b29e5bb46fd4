"""Figure that compares several runs."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core.errors import AnyPath
from ..core.player_colours import markers_of
from ..core.poses import Array
from ..games.run import Run
from ..games.support_foot_columns import express_in_support_foot
from .cycle_means import whole_cycles
from .figure_style import (
    LIGHT,
    LINES,
    THEORY,
    colours_of,
    legend_below,
    mark_level,
    panels,
    save,
)
from .plan_view import draw_pushes
from .text_escaping import for_figure

RUNS = ("#222222", *LIGHT.others)


def draw_runs(runs: Sequence[Run], file: AnyPath) -> None:
    """Draw paths and, over gait cycles, what the runs have in common.

    Of games, that is the distance and, of two players, the angle between
    the headings; of walks, tilt and speed.

    Args:
        runs: The runs; each has its own line style.
        file: Figure to write.
    """
    walks = all(len(run.players) == 1 for run in runs)
    turned = any(run.has_orientation for run in runs)
    rows = ["pd", "pa"] if turned or walks else ["pd"]
    columns = 3
    figure, axes = panels(
        rows,
        9.5,
        [1.9] * len(rows) if len(rows) > 1 else [3.6],
        legend=-(-len(runs) // columns),
        right=0.95,
    )
    for number, run in enumerate(runs):
        look: dict[str, Any] = {
            "color": RUNS[number % len(RUNS)],
            "ls": LINES[number % len(LINES)],
            "alpha": 1.0 - 0.6 * (number // len(RUNS)) / len(runs),
            "lw": 1.1,
        }
        _draw_paths(axes["p"], run, look, coloured=not walks)
        for key, values in zip("da", _measures(run), strict=True):
            if key in axes:
                label = for_figure(run.name)
                axes[key].plot(run.times, values, label=label, **look)
    if not walks:
        _draw_theories(axes, runs)
    axes["p"].set_aspect("equal", adjustable="datalim")
    roles = "" if walks else ": pursuers red, evaders blue, others grey"
    axes["p"].set(title=f"paths{roles}", xlabel="x [m]", ylabel="y [m]")
    labels = {"d": "distance [m]", "a": "angle between headings [deg]"}
    if walks:
        labels = {"d": "tilt [deg]", "a": "speed [m/s]"}
    for key in axes.keys() - {"p"}:
        axes[key].set(xlabel="time [s]", ylabel=labels[key])
    legend_below(figure, [axes["d"]], ncols=columns)
    save(figure, file)


def _draw_paths(
    axes: Any, run: Run, look: dict[str, Any], *, coloured: bool
) -> None:
    """Draw the paths of the torsos, in the players' colours or the run's."""
    markers = markers_of(run.tracks) if len(run.players) > 2 else {}
    for name, colour in colours_of(run).items():
        own = look | {"color": colour} if coloured else look
        track = run.tracks[name]
        axes.plot(
            *track.torso[:, :2].T,
            marker=markers.get(name),
            markevery=max(1, len(run.times) // 8),
            ms=4.0,
            **own,
        )
        draw_pushes(axes, track.pushes)


def _measures(run: Run) -> tuple[Array, Array]:
    """Return distance and angle, or of a walk tilt [deg] and speed [m/s]."""
    cycle = run.settings.cycle
    if len(run.players) > 1:
        distance, angle = run.distance, run.orientation
        return (
            whole_cycles(distance, run.times, cycle),
            whole_cycles(angle, run.times, cycle),
        )
    (track,) = run.tracks.values()
    tilt = np.full(len(run.times), np.nan)
    if track.sole is not None:
        seen = express_in_support_foot(run.times, track)
        tilt = np.degrees(np.hypot(seen["roll"], seen["pitch"]))
    return tilt, mean_speed(track.unicycle, run.times, cycle)


def mean_speed(places: Array, times: Array, period: float) -> Array:
    """Return the mean speed over the gait cycle around each sample.

    Args:
        places: Positions in the world, in [m]. Shape (n, 2) or more columns.
        times: Their times, in [s]. Shape (n,).
        period: Duration of a gait cycle, in [s].

    Returns:
        Speeds, in [m/s]; NaN within half a cycle of both ends. Shape (n,).
    """
    speed = np.full(len(times), np.nan)
    if len(times) < 2:
        return speed
    half = max(1, round(0.5 * period / float(times[1] - times[0])))
    if len(times) > 2 * half:
        way = places[2 * half :, :2] - places[: -2 * half, :2]
        passed = times[2 * half :] - times[: -2 * half]
        speed[half:-half] = np.hypot(way[:, 0], way[:, 1]) / passed
    return speed


def _draw_theories(axes: Any, runs: Sequence[Run]) -> None:
    """Draw each distinct value of the theory once.

    A value that is not common to all runs has the colour and line style of
    the first run that has it.
    """
    for key, column, unit in (("d", 1, " m"), ("a", 2, "°")):
        if key not in axes:
            continue
        levels: dict[float, int] = {}
        theories = [run.theory for run in runs]
        for number, theory in enumerate(theories):
            if theory is not None:
                levels.setdefault(round(theory[column], 6), number)
        shared = len(levels) == 1 and all(theories)
        low, high = axes[key].get_ylim()
        near = 0.08 * (max(high, *levels, low) - min(low, *levels, high))
        for level, number in levels.items():
            colour = THEORY if shared else RUNS[number % len(RUNS)]
            line = "--" if shared else LINES[number % len(LINES)]
            # Labels that would overlap become one, at the first level.
            close = [x for x in levels if abs(x - level) < near]
            values = ", ".join(f"{x:.3g}" for x in sorted(close))
            name = f"theory {values}{unit}" if level == close[0] else ""
            mark_level(axes[key], level, name, colour, line)
