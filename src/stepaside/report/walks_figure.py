"""Figure that compares several walks."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..core.poses import Array
from ..games.run import Run
from ..games.support_foot_columns import express_in_support_foot
from .figure_style import LIGHT, new_figure, save
from .push_marks import draw_pushes
from .text_escaping import for_figure

LINES = ("-", "--", ":", "-.")


def draw_walks(runs: Sequence[Run], file: Path) -> None:
    """Draw paths, tilt, and speed over gait cycles, of each first walker.

    Args:
        runs: The walks; each has its own colour and line style.
        file: Figure to write.
    """
    figure = new_figure(9.5, 5.8)
    axes = figure.subplot_mosaic([["path", "path"], ["tilt", "speed"]])
    for number, run in enumerate(runs):
        (track,) = run.tracks.values()
        look: dict[str, Any] = {
            "color": LIGHT.others[number % len(LIGHT.others)],
            "linestyle": LINES[number // len(LIGHT.others) % len(LINES)],
            "linewidth": 1.1,
        }
        name = for_figure(run.name)
        axes["path"].plot(*track.com[:, :2].T, label=name, **look)
        draw_pushes(axes["path"], track.pushes)
        if track.sole is not None:
            seen = express_in_support_foot(run.times, track)
            tilt = np.degrees(np.hypot(seen["roll"], seen["pitch"]))
            axes["tilt"].plot(run.times, tilt, **look)
        cycle = 2.0 * run.settings.gait.step_duration
        speed = mean_speed(track.unicycle, run.times, cycle)
        axes["speed"].plot(run.times, speed, **look)
    axes["path"].set_aspect("equal", adjustable="datalim")
    axes["path"].set(xlabel="x [m]", ylabel="y [m]", title="CoM paths")
    handles, labels = axes["path"].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    axes["tilt"].set(xlabel="time [s]", ylabel="tilt [deg]")
    axes["speed"].set(xlabel="time [s]", ylabel="speed [m/s]")
    save(figure, file)


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
