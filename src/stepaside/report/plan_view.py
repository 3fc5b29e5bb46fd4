"""Top views: room, paths, footsteps, pushes, players; and of one plan."""

from collections.abc import Iterable
from math import cos, sin
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, Patch
from matplotlib.patches import Polygon as Outline

from ..arena import BODY_RADIUS, Obstacle, Room
from ..core.errors import AnyPath
from ..core.poses import Array
from ..games.run import Run
from ..planning import ManeuverPlan
from .figure_style import (
    COLOURS,
    MEAN,
    PUSHED,
    THEORY,
    colours_of,
    legend_above,
    legend_below,
    panels,
    save,
)
from .overlays import overlays_of, soles
from .palette import markers_of

SOLID, MOVING = "#8a8f98", "#99704a"
MARKED = 12  # markers along a path, at most


def solid_patches(solids: Iterable[Obstacle], **look: Any) -> list[Patch]:
    """Return walls and obstacles as patches of Matplotlib."""
    look = {"facecolor": SOLID, "edgecolor": "none", "zorder": 1} | look
    return [Outline(solid.outline, closed=True, **look) for solid in solids]


def draw_solids(axes: Any, room: Room | None, time: float = 0.0) -> None:
    """Draw a room, with moving boxes at a time [s], outlined at their ends."""
    if room is None:
        return
    now = [box.at(time) for box in room.moving]
    ends = [end for box in room.moving for end in box.ends]
    outline = {"facecolor": "none", "edgecolor": MOVING, "linestyle": "--"}
    for patch in (
        *solid_patches(room.solids),
        *solid_patches(now, facecolor=MOVING),
        *solid_patches(ends, **outline),
    ):
        axes.add_patch(patch)


def draw_room(room: Room, path: str) -> None:
    """Write a figure of a room with the initial poses."""
    figure, axes = panels(["a"], 4.0, [3.2], legend=1)
    draw_solids(axes["a"], room)
    for (x, y, theta), (name, colour) in zip(
        room.starts or (), COLOURS.items(), strict=False
    ):
        body = Circle((x, y), BODY_RADIUS, fc=colour, alpha=0.35, lw=0)
        axes["a"].add_patch(body)
        nose = x + BODY_RADIUS * cos(theta), y + BODY_RADIUS * sin(theta)
        line = (x, nose[0]), (y, nose[1])
        axes["a"].plot(*line, color=colour, lw=2, label=name)
    axes["a"].autoscale_view()
    axes["a"].set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    legend_below(figure, axes.values(), ncols=2)
    save(figure, path)


def draw_heading(axes: Any, pose: Array, colour: str, size: float) -> None:
    """Draw a player as a wedge along its heading, of a length in [m]."""
    shape = size * np.array(
        [[0.6, 0.0], [-0.4, 0.35], [-0.2, 0.0], [-0.4, -0.35]]
    )
    x, y, theta = pose.tolist()
    c, s = cos(theta), sin(theta)
    corners = shape @ np.array([[c, s], [-s, c]]) + (x, y)
    axes.add_patch(
        Outline(corners, closed=True, fc=colour, ec="white", lw=0.6, zorder=5)
    )


def draw_lines(axes: Any, segments: Array, colour: str, **look: Any) -> None:
    """Draw segments, in [m]. Shape (n, 2, 2)."""
    axes.add_collection(LineCollection([*segments], colors=colour, **look))


def draw_pushes(axes: Any, pushes: Array | None) -> None:
    """Draw pushes as arrows; rows as in ``Trajectory.pushes``."""
    for _, _, x, y, *impulse in () if pushes is None else pushes.tolist():
        start = np.array([x, y]) - 0.2 * np.array(impulse)
        arrow = {"arrowstyle": "-|>", "color": PUSHED, "lw": 1.6}
        axes.annotate("", (x, y), start, arrowprops=arrow, zorder=6)
        # Annotations do not count for the limits of the axes; a dot does.
        axes.plot(*start, ".", color=PUSHED, ms=2)


def draw_snapshots(shown: Iterable[Any], run: Run, times: Array) -> None:
    """Draw top views at some times, in [s], with the paths so far."""
    low, high = _frame(run)
    size = max(0.28, 0.07 * float((high - low).max()))
    across = "y [m]"
    for axes, time in zip(shown, times.tolist(), strict=True):
        index = run.index_at(time)
        draw_solids(axes, run.plan, time)
        for name, colour in colours_of(run).items():
            track = run.tracks[name]
            axes.plot(*track.com[: index + 1, :2].T, color=colour, lw=1.0)
            draw_heading(axes, track.torso[index], colour, size)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        axes.set(aspect="equal", title=f"{run.times[index]:.1f} s")
        axes.set(xlabel="x [m]", ylabel=across)
        axes.locator_params(nbins=4)
        across = ""


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


def draw_paths(axes: Any, run: Run) -> None:
    """Draw CoM paths with all footsteps and pushes."""
    draw_solids(axes, run.plan, float(run.times[-1]))
    every = np.concatenate([track.com[:, :2] for track in run.tracks.values()])
    extent = float(np.ptp(every, axis=0).max())
    # As large as a robot, larger for long paths.
    size = min(max(0.2, 0.04 * extent), 0.1 * extent + 0.02)
    colours = colours_of(run)
    many = len(colours) > 2
    markers = markers_of(run.tracks) if many else {}
    for overlay in overlays_of(run):
        if overlay.layer == "footsteps":
            colour = colours[overlay.owner]
            draw_lines(axes, overlay.segments, colour, alpha=0.35, lw=0.5)
    for name, colour in colours.items():
        track = run.tracks[name]
        axes.plot(
            *track.com[:, :2].T,
            color=colour,
            marker=markers.get(name),
            markevery=max(1, len(run.times) // MARKED),
            ms=4.5,
            lw=1.4,
            label=f"{name}, CoM" if name in run.robots else name,
        )
        axes.plot(*track.com[0, :2], "o", color=colour, ms=5)
        draw_heading(axes, track.torso[-1], colour, size)
        draw_pushes(axes, track.pushes)
        goal = run.settings.player(name).goal if run.game == "game" else ()
        if goal:
            axes.plot(*goal, marker="+", color=colour, ms=9, mew=1.8)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title("top view; dot: start, wedge: end", pad=18)


def draw_plan(plan: ManeuverPlan, role: str, path: AnyPath) -> None:
    """Write the figure of a maneuver: footsteps, ZMP and CoM.

    Args:
        plan: Plan of the maneuver.
        role: "pursuer" or "evader", for the colour.
        path: File to write; its suffix gives the format.
    """
    colour = COLOURS[role]
    sole = plan.schedule.settings.sole
    samples = plan.sample(np.arange(0.0, plan.schedule.duration, 0.01))
    _, axes = panels(["px", "py"], 9.5, [1.6, 1.6])
    above = axes["p"]
    sides = plan.first_foot.value * (-1.0) ** np.arange(len(plan.placements))
    outlines = soles(np.column_stack([sides, plan.placements]), sole)
    draw_lines(above, outlines[:8], THEORY, ls=":")  # of both feet at first
    draw_lines(above, outlines[8:], colour, alpha=0.7)
    above.plot(*samples.zmp.T, color=THEORY, lw=0.8, label="ZMP")
    above.plot(*samples.com.T, color=colour, lw=2.0, label="CoM")
    above.set(xlabel="x in the plan frame [m]", ylabel="y [m]")
    above.set_aspect("equal", adjustable="datalim")
    title = f"{role}: desired heading {np.degrees(plan.bearing):.1f}°"
    legend_above(above, title, 2)
    lines = (
        ("ZMP", samples.zmp, {"color": THEORY, "lw": 0.9}),
        ("DCM", samples.dcm, {"color": MEAN, "lw": 0.9, "ls": "--"}),
        ("CoM", samples.com, {"color": colour, "lw": 1.8}),
    )
    for index, name in enumerate("xy"):
        for label, points, look in lines:
            axes[name].plot(
                samples.times, points[:, index], label=label, **look
            )
        axes[name].set(xlabel="time [s]", ylabel=f"{name} [m]")
    legend_above(axes["x"], "", 3)
    save(above.figure, path)
