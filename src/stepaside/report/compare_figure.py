"""Figure that compares several runs."""

from collections.abc import Sequence
from typing import Any

from ..core.errors import AnyPath
from ..core.player_colours import markers_of
from ..games.run import Run, is_match
from .cycle_means import whole_cycles
from .figure_sizes import sheet
from .figure_style import THEORY, colours_of, mark_level, new_figure, save
from .text_escaping import for_figure

LINES = ("-", "--", ":", "-.")
RUNS = ("#222222", "#0b6a5d", "#8f4f14", "#6a3d9a")


def draw_comparison(runs: Sequence[Run], file: AnyPath) -> None:
    """Draw paths, and distance and orientation over gait cycles.

    Args:
        runs: The runs; each has its own line style.
        file: Figure to write.
    """
    turned = any(run.has_orientation for run in runs)
    if not turned:
        figure = new_figure(9.5, 4.2)
        axes = figure.subplot_mosaic([["path", "distance"]])
    elif sheet().narrow:
        figure = new_figure(4.2, 6.8)
        places = [["path"], ["distance"], ["angle"]]
        axes = figure.subplot_mosaic(places, height_ratios=[2, 1, 1])
    else:
        figure = new_figure(9.5, 5.2)
        axes = figure.subplot_mosaic([["path", "distance"], ["path", "angle"]])
    for number, run in enumerate(runs):
        line = LINES[number % len(LINES)]
        cycle = run.settings.cycle
        shade = 1.0 - 0.6 * (number // len(LINES)) / max(1, len(runs))
        markers = markers_of(run.tracks) if is_match(run) else {}
        for name, colour in colours_of(run.players, run.identities).items():
            place = run.tracks[name].torso
            axes["path"].plot(
                place[:, 0],
                place[:, 1],
                color=colour,
                linestyle=line,
                alpha=shade,
                linewidth=1.1,
                marker=markers.get(name),
                markevery=max(1, len(place) // 8),
                markersize=4.0,
            )
        for key, values in (
            ("distance", run.distance),
            ("angle", run.orientation),
        ):
            if key not in axes:
                continue
            axes[key].plot(
                run.times,
                whole_cycles(values, run.times, cycle),
                color=RUNS[number % len(RUNS)],
                linestyle=line,
                alpha=shade,
                linewidth=1.1,
                label=for_figure(run.name),
            )
    _draw_theories(axes, runs)
    axes["path"].set_aspect("equal", adjustable="datalim")
    roles = "pursuer red, evader blue"
    if any(is_match(run) for run in runs):
        roles = "pursuers red, evaders blue, others grey"
    axes["path"].set_title(f"paths of the torsos: {roles}")
    axes["path"].set_xlabel("x [m]")
    axes["path"].set_ylabel("y [m]")
    axes["distance"].set_ylabel("distance [m]")
    if turned:
        axes["angle"].set_ylabel("angle between headings [deg]")
    axes["angle" if turned else "distance"].set_xlabel("time [s]")
    handles, labels = axes["distance"].get_legend_handles_labels()
    columns = 1 if sheet().narrow else 3
    figure.legend(handles, labels, loc="outside lower center", ncols=columns)
    save(figure, file)


def _draw_theories(axes: Any, runs: Sequence[Run]) -> None:
    """Draw each distinct value of the theory once.

    A value that is not common to all runs has the colour and line style of
    the first run that has it.
    """
    for key, column, unit in (("distance", 1, " m"), ("angle", 2, "°")):
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
