"""Figure of a walk: path, torso tilt, CoM error and balance."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from ..games.run import Run
from ..games.support_foot_columns import express_in_support_foot
from ..games.trajectory import Trajectory
from .duel_figure import draw_paths
from .figure_style import LEFT, MEAN, RIGHT, THEORY, new_figure, save
from .push_marks import mark_pushes
from .text_escaping import for_figure

BEFORE, AFTER = 1.0, 4.0  # time shown before and after a push, in [s]
STEPS = 6.0  # last steps that are shown without a push


def draw_walk(run: Run, path: Path) -> None:
    """Write the figure of a walk, with details of the first walker.

    Args:
        run: The walk.
        path: File to write; its suffix gives the format.
    """
    (track,) = run.tracks.values()
    figure = new_figure(11.0, 8.2)
    grid = figure.add_gridspec(4, 2, height_ratios=[1.5, 0.9, 0.9, 1.1])
    draw_paths(figure.add_subplot(grid[0, :]), run)
    if track.sole is not None:
        _draw_over_time(figure, grid, run, track)
    if track.zmp_reference is not None:
        show, when = _while_shown(run, track)
        for column, forward in enumerate((False, True)):
            axes = figure.add_subplot(grid[3, column])
            _draw_balance(axes, run.times[show], _cut(track, show), forward)
            mark_pushes(axes, run)
            axes.set_xlim(*_limits(run.times[show]))
            axes.set_title(when, pad=18)
    figure.suptitle(
        f"{run.title}: {for_figure(run.message)}",
    )
    save(figure, path)


def _draw_over_time(
    figure: Any, grid: Any, run: Run, track: Trajectory
) -> None:
    """Draw roll and pitch of the torso, and the CoM error."""
    times, seen = run.times, express_in_support_foot(run.times, track)
    upper = figure.add_subplot(grid[1, :])
    lower = figure.add_subplot(grid[2, :], sharex=upper)
    for lean, axis, colour, label in (
        ("roll", "y", LEFT, "leftward"),
        ("pitch", "x", RIGHT, "forward"),
    ):
        off = seen[f"com_{axis}"] - seen[f"com_reference_{axis}"]
        tilt = np.degrees(seen[lean])
        upper.plot(times, tilt, color=colour, lw=1.0, label=lean)
        lower.plot(times, 1e3 * off, color=colour, lw=1.0, label=label)
    upper.set_ylabel("torso [deg]")
    lower.set(ylabel="CoM error [mm]", xlabel="time [s]")
    for axes in (upper, lower):
        mark_pushes(axes, run)
        axes.margins(x=0.0)
        axes.legend(ncols=2, loc="lower right", bbox_to_anchor=(1.0, 0.94))


def _while_shown(run: Run, track: Trajectory) -> tuple[NDArray[np.bool_], str]:
    """Return the samples around the first push, or of the last steps."""
    pushes, times = track.pushes, run.times
    if pushes is None:
        span = STEPS * run.settings.gait.step_duration
        return times >= times[-1] - span, "last steps"
    first = float(pushes[0, 0])
    shown = (times >= first - BEFORE) & (times <= first + AFTER)
    return shown, f"the push at {first:.1f} s"


def _cut(track: Trajectory, show: NDArray[np.bool_]) -> dict[str, Array]:
    """Return heading, ZMP and CoM with their references at some samples."""
    assert track.com_reference is not None
    assert track.zmp_reference is not None and track.zmp is not None
    return {
        "heading": track.torso[show, 2],
        "ZMP": track.zmp[show],
        "ZMP reference": track.zmp_reference[show],
        "CoM reference": track.com_reference[show],
        "CoM": track.com[show, :2],
    }


def _draw_balance(
    axes: Any, times: Any, cut: Mapping[str, Array], forward: bool
) -> None:
    """Draw CoM and ZMP, leftward or forward.

    References are in odometry, true values in the world, so that each are
    relative to their own mean. Forward, the mean motion of the reference is
    subtracted.
    """
    heading = float(cut["heading"].mean())
    c, s = np.cos(heading), np.sin(heading)
    axis = np.array([c, s] if forward else [-s, c])
    looks = {
        "ZMP": {"color": "#b0b0b0", "lw": 0.8},
        "ZMP reference": {"color": THEORY, "lw": 1.2},
        "CoM reference": {"color": MEAN, "lw": 1.2, "ls": "--"},
        "CoM": {"color": LEFT, "lw": 1.6},
    }
    way: Any = np.zeros(len(times))
    if forward and len(times) > 1:
        asked = cut["CoM reference"] @ axis
        way = np.polyval(np.polyfit(times, asked - asked.mean(), 1), times)
    for label, look in looks.items():
        same = "CoM reference" if "reference" in label else "CoM"
        along = (cut[label] - cut[same].mean(axis=0)) @ axis
        axes.plot(times, 1e3 * (along - way), label=label, **look)
    axes.set(
        xlabel="time [s]",
        ylabel="forward, less mean [mm]" if forward else "leftward [mm]",
    )
    axes.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 0.97))


def _limits(times: Any) -> tuple[float, float]:
    """Return first and last time, in [s], at least 0.02 s apart."""
    first, last = float(times[0]), float(times[-1])
    return first, max(last, first + 0.02)
