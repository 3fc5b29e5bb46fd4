"""Figure of a duel in the manner of the paper's Fig. 5."""

from typing import Any

import numpy as np

from ..core.errors import AnyPath
from ..core.poses import Array
from ..games.run import Run, is_duel
from .cycle_means import whole_cycles
from .figure_sizes import sheet
from .figure_style import (
    MEAN,
    SWAY,
    THEORY,
    colours_of,
    mark_level,
    new_figure,
    save,
)
from .landed_footsteps import footsteps_in
from .push_marks import draw_pushes, mark_pushes
from .room_figure import draw_clearance, has_obstacles, room_patches
from .sole_outlines import draw_heading, draw_soles
from .text_escaping import for_figure

SNAPSHOTS = 4
STEPS = 6.0  # last steps whose balance is shown


def draw_duel(
    run: Run,
    path: AnyPath,
) -> None:
    """Write the figure of a duel, or of another game of several players.

    Args:
        run: The game.
        path: File to write; its suffix gives the format.
    """
    # Robots that are controlled elsewhere have no recorded plans.
    walkers = [n for n, t in run.tracks.items() if t.zmp_reference is not None]
    if has_obstacles(run):
        walkers = [""]  # one panel with the clearance of all players
    if sheet().narrow:
        figure = new_figure(4.2, 8.6 + 1.5 * len(walkers))
        rows = [2.3, 2.5, 2.0] + [1.2] * len(walkers)
        parts = figure.subfigures(len(rows), 1, height_ratios=rows)
        above, paths, over_time, *below = parts
        places = [(part, (1, 1, 1)) for part in below]
    else:
        rows = [1.0, 1.7] + [1.1] * bool(walkers)
        figure = new_figure(11.0, 2.16 * sum(rows))
        above, middle, *below = figure.subfigures(
            len(rows), 1, height_ratios=rows
        )
        paths, over_time = middle.subfigures(1, 2, width_ratios=[1.0, 1.15])
        count = len(walkers)
        places = [
            (part, (1, count, i + 1)) for part in below for i in range(count)
        ]
    _draw_snapshots(above, run)
    draw_paths(paths.add_subplot(), run)
    _draw_over_time(over_time, run)
    for name, (part, place) in zip(walkers, places, strict=True):
        axes = part.add_subplot(*place)
        if has_obstacles(run):
            draw_clearance(axes, run)
        else:
            _draw_balance(axes, run, name)
    figure.suptitle(f"{run.title}: {for_figure(run.message)}")
    save(figure, path)


def _draw_snapshots(figure: Any, run: Run) -> None:
    """Draw top views at four times, with the paths so far."""
    times = run.times
    # Quadratic spacing, since more happens early.
    fractions = (np.arange(SNAPSHOTS) / (SNAPSHOTS - 1)) ** 2
    lines = 2 if sheet().narrow else 1
    shown = figure.subplots(
        lines, SNAPSHOTS // lines, sharex=True, sharey=True, squeeze=False
    )
    for axes, time in zip(shown.flat, fractions * times[-1], strict=True):
        index = min(int(np.searchsorted(times, time)), len(times) - 1)
        draw_top(axes, run, index)
        axes.set_title(f"{times[index]:.1f} s")
    for axes in shown[-1]:
        axes.set_xlabel("x [m]")
    for axes in shown[:, 0]:
        axes.set_ylabel("y [m]")


def draw_top(axes: Any, run: Run, index: int) -> None:
    """Draw the top view of a sample, with the paths so far.

    Args:
        axes: Matplotlib axes, scaled to the whole run.
        run: The run.
        index: Sample.
    """
    low, high = _frame(run)
    size = max(0.28, 0.07 * float((high - low).max()))
    _draw_solids(axes, run, float(run.times[index]))
    for name, colour in colours_of(run.players, run.identities).items():
        track = run.tracks[name]
        axes.plot(*track.com[: index + 1, :2].T, color=colour, lw=1.0)
        draw_heading(axes, track.torso[index], colour, size)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")


def _frame(run: Run) -> tuple[Array, Array]:
    """Return the corners of the top views, in [m]. Shapes (2,).

    No side is shorter than half of the other.
    """
    every = np.concatenate([track.com[:, :2] for track in run.tracks.values()])
    low, high = every.min(axis=0) - 0.2, every.max(axis=0) + 0.2
    plan = run.plan
    if plan is not None and plan.has_walls:
        half = 0.5 * np.array([plan.width, plan.depth]) + 0.15
        low, high = np.minimum(low, -half), np.maximum(high, half)
    lacks = 0.5 * (high - low).max() - (high - low)
    grown = 0.5 * np.maximum(lacks, 0.0)
    return low - grown, high + grown


def _draw_solids(axes: Any, run: Run, time: float) -> None:
    """Draw the obstacles of the room, if there is one, at a time in [s]."""
    for patch in () if run.plan is None else room_patches(run.plan, time):
        axes.add_patch(patch)


def draw_paths(axes: Any, run: Run) -> None:
    """Draw CoM paths with all footsteps and pushes.

    Args:
        axes: Matplotlib axes.
        run: The run.
    """
    _draw_solids(axes, run, float(run.times[-1]))
    every = np.concatenate([track.com[:, :2] for track in run.tracks.values()])
    extent = float(np.ptp(every, axis=0).max())
    # As large as a robot, larger for long paths.
    size = min(max(0.2, 0.04 * extent), 0.1 * extent + 0.02)
    colours = colours_of(run.players, run.identities)
    footsteps = footsteps_in(run)
    for name, colour in colours.items():
        track = run.tracks[name]
        if len(footsteps[name]):
            sole = run.settings.robot_of(name).gait.sole
            draw_soles(axes, footsteps[name], sole, colour, alpha=0.25, lw=0.4)
        com = track.com
        label = f"{name}, CoM" if name in run.robots else name
        axes.plot(*com[:, :2].T, color=colour, lw=1.2, label=label)
        axes.plot(*com[0, :2], "o", color=colour, ms=5)
        draw_heading(axes, track.torso[-1], colour, size)
        draw_pushes(axes, track.pushes)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title("top view; dot: start, wedge: end", pad=18)
    axes.legend(
        loc="lower center", bbox_to_anchor=(0.5, 0.985), ncols=len(colours)
    )


def _draw_over_time(figure: Any, run: Run) -> None:
    """Draw distance and angle between headings with the theory's values."""
    times = run.times
    theory_distance = theory_angle = None
    if is_duel(run):
        theory = run.summary.theory
        theory_distance = theory.distance_m
        theory_angle = theory.relative_orientation_deg
    period = run.settings.cycle
    panels = (
        (run.distance, theory_distance, "distance [m]", "{:.3g} m"),
        (run.orientation, theory_angle, "angle [deg]", "{:.3g}°"),
    )
    shown = figure.subplots(2, 1, sharex=True)
    guarded, radius = run.safety or ("", np.inf)
    for axes, (values, value, label, form) in zip(shown, panels, strict=True):
        assert values is not None
        axes.plot(times, values, color=SWAY, lw=0.8, label="every sample")
        mean = whole_cycles(values, times, period)
        mean_label = "mean over a gait cycle"
        axes.plot(times, mean, color=MEAN, lw=1.6, label=mean_label)
        if value is not None:
            # The label of the higher line is above it, the other below.
            va = "center"
            if axes is shown[0]:
                va = "bottom" if value > radius else "top"
            name = f"theory {form.format(value)}"
            mark_level(axes, value, name, THEORY, va=va)
        mark_pushes(axes, run)
        axes.set_ylabel(label)
        axes.margins(x=0.0)
    if np.isfinite(radius):
        name = f"safety radius\n{radius:.3g} m"
        colour = colours_of(run.players, run.identities)[guarded]
        above = theory_distance is not None and theory_distance <= radius
        va = "bottom" if above else "top"
        mark_level(shown[0], radius, name, colour, ":", va=va)
    shown[0].set_title(
        "distance between the players, angle between their headings"
        if not sheet().narrow
        else "distance, angle between the headings",
        pad=18,
    )
    shown[0].legend(loc="lower center", bbox_to_anchor=(0.5, 0.965), ncols=3)
    shown[1].set_xlabel("time [s]")


def _draw_balance(axes: Any, run: Run, name: str) -> None:
    """Draw CoM and ZMP of one robot during the last steps, leftward."""
    times, track = run.times, run.tracks[name]
    colour = colours_of(run.players, run.identities)[name]
    span = 0.5 * STEPS * run.settings.cycle
    show = times >= times[-1] - span
    heading = float(track.torso[show][:, 2].mean())
    left = np.array([-np.sin(heading), np.cos(heading)])
    assert track.com_reference is not None
    origin = track.com_reference[show].mean(axis=0)
    shift = track.com[show, :2].mean(axis=0)

    def line(
        label: str, points: Array | None, centre: Array, **style: Any
    ) -> None:
        assert points is not None
        across = (points[show, :2] - centre) @ left
        axes.plot(times[show], 1e3 * across, label=label, **style)

    line("ZMP", track.zmp, shift, color="#a0a0a0", lw=0.8)
    line("ZMP reference", track.zmp_reference, origin, color=THEORY, lw=1.2)
    # Dashed and on top, so that both are visible where they coincide.
    line("CoM", track.com, shift, color=colour, lw=2.0)
    line(
        "CoM reference",
        track.com_reference,
        origin,
        color="#e0a400",
        lw=1.2,
        ls=(0, (3, 2)),
    )
    axes.set(xlabel="time [s]", ylabel="leftward [mm]")
    axes.margins(x=0.0)
    axes.set_title(f"{name}: lateral balance, last steps", pad=18)
    axes.legend(
        ncols=4,
        loc="lower center",
        bbox_to_anchor=(0.5, 0.97),
        columnspacing=1.2,
        handlelength=1.6,
    )
