"""Figure of a game of any number of players."""

from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ..core.player_colours import markers_of
from ..core.poses import Array
from ..games.duel_circle import cycle_mean, distance_between
from ..games.run import MatchRun
from .duel_figure import draw_top
from .figure_sizes import sheet
from .figure_style import colours_of, mark_level, new_figure, save
from .landed_footsteps import footsteps_in
from .push_marks import draw_pushes
from .room_figure import room_patches
from .sole_outlines import draw_heading, draw_soles
from .text_escaping import for_figure

SNAPSHOTS = 4
MOST_CURVES = 10  # of distances between pairs; beyond, the nearest of each
MARKED = 12  # markers along a path or a curve, at most
LINES = ("-", "--", "-.", ":")


def draw_game(run: MatchRun, path: Path) -> None:
    """Write the figure of a game: top views, paths and distances.

    Args:
        run: The game.
        path: File to write; its suffix gives the format.
    """
    narrow = sheet().narrow
    figure = new_figure(4.2, 11.5) if narrow else new_figure(11.0, 8.6)
    if narrow:
        above, paths, over_time = figure.subfigures(
            3, 1, height_ratios=[2.2, 2.8, 2.4]
        )
    else:
        above, below = figure.subfigures(2, 1, height_ratios=[1.0, 1.9])
        paths, over_time = below.subfigures(1, 2, width_ratios=[1.0, 1.1])
    _draw_snapshots(above, run)
    _draw_paths(paths.add_subplot(), run)
    _draw_distances(over_time.add_subplot(), run)
    figure.suptitle(f"{run.title}: {for_figure(run.message)}")
    save(figure, path)


def _draw_snapshots(figure: Any, run: MatchRun) -> None:
    """Draw top views at evenly spaced times, with the paths so far."""
    columns = 2 if sheet().narrow else SNAPSHOTS
    shown = figure.subplots(
        SNAPSHOTS // columns, columns, sharex=True, sharey=True, squeeze=False
    )
    for axes, time in zip(
        shown.flat, np.linspace(0.0, run.times[-1], SNAPSHOTS), strict=True
    ):
        index = run.index_at(float(time))
        draw_top(axes, run, index)
        axes.set_title(f"{run.times[index]:.1f} s")
        axes.margins(0.12)  # wedges are not cut off at the edge
    for axes in shown[-1]:
        axes.set_xlabel("x [m]")
    for axes in shown[:, 0]:
        axes.set_ylabel("y [m]")


def _draw_paths(axes: Any, run: MatchRun) -> None:
    """Draw the paths of all players with markers, footsteps and goals."""
    if run.plan is not None:
        for patch in room_patches(run.plan, float(run.times[-1])):
            axes.add_patch(patch)
    colours = colours_of(run.players, run.identities)
    markers = markers_of(run.tracks)
    every = np.concatenate([track.com[:, :2] for track in run.tracks.values()])
    size = min(max(0.14, 0.04 * float(np.ptp(every, axis=0).max())), 0.35)
    spacing = max(1, len(run.times) // MARKED)
    footsteps = footsteps_in(run)
    for name, colour in colours.items():
        track = run.tracks[name]
        if len(footsteps[name]):
            sole = run.settings.robot_of(name).gait.sole
            draw_soles(axes, footsteps[name], sole, colour, alpha=0.2, lw=0.3)
        axes.plot(
            *track.com[:, :2].T,
            color=colour,
            marker=markers[name],
            markevery=spacing,
            ms=4.5,
            lw=1.2,
            label=f"{name} ({run.identities[name].role})",
        )
        draw_heading(axes, track.torso[-1], colour, size)
        draw_pushes(axes, track.pushes)
        goal = run.settings.player(name).goal
        if goal:
            axes.plot(*goal, marker="+", color=colour, ms=9, mew=1.8)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title("top view; wedge: end, plus: goal", pad=6)
    columns = 2 if len(colours) < 9 else 3
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=columns)


def _draw_distances(axes: Any, run: MatchRun) -> None:
    """Draw the distance of each pair, or of each player to the nearest."""
    colours = colours_of(run.players, run.identities)
    markers = markers_of(run.tracks)
    spacing = max(1, len(run.times) // MARKED)
    curves = _curves_of(run)
    for number, (label, name, other, values) in enumerate(curves):
        mean = cycle_mean(values, run.times, run.settings.cycle)
        axes.plot(
            run.times,
            mean,
            color=colours[name],
            ls=LINES[number % len(LINES)],
            marker=markers[other] if other else markers[name],
            markevery=spacing,
            ms=4.5,
            lw=1.3,
            label=label,
        )
        closest = int(values.argmin())
        axes.plot(
            run.times[closest], values[closest], "x", color=colours[name]
        )
    if run.summary.crowd:
        for limit in (0.45, 1.2):
            mark_level(axes, limit, f"{limit:g} m", "#888888", ":")
    axes.set(xlabel="time [s]", ylabel="distance [m]")
    axes.set_ylim(bottom=0.0)
    axes.margins(x=0.0)
    axes.set_title("distances, mean over a gait cycle; cross: closest", pad=6)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)


def _curves_of(run: MatchRun) -> list[tuple[str, str, str, Array]]:
    """Return label, player, other player and distance of each curve."""
    pairs = [*combinations(run.players, 2)]
    tracks = {name: track.unicycle for name, track in run.tracks.items()}
    if len(pairs) <= MOST_CURVES:
        return [
            (
                f"{one} - {other}",
                one,
                other,
                distance_between(tracks[one], tracks[other]),
            )
            for one, other in pairs
        ]
    deciding = [p.name for p in run.settings.players if p.decides]
    found = []
    for name in deciding or run.players:
        nearest = np.min(
            [
                distance_between(tracks[name], track)
                for other, track in tracks.items()
                if other != name
            ],
            axis=0,
        )
        found.append((f"{name} - nearest", name, "", nearest))
    return found
