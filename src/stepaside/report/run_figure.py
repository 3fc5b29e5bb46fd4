"""Figure of a game of any kind, in the manner of the paper's Fig. 5."""

from collections.abc import Callable, Sequence
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ..arena import BODY_RADIUS, Room
from ..core.errors import AnyPath
from ..core.poses import Array
from ..games.run import Run
from ..games.trajectory import distance_between, whole_cycles
from .figure_style import (
    LEFT,
    LIGHT,
    LINES,
    MEAN,
    PUSHED,
    RIGHT,
    SWAY,
    THEORY,
    colours_of,
    legend_above,
    legend_below,
    mark_level,
    panels,
    save,
)
from .overlays import safety_areas
from .palette import markers_of
from .plan_view import MARKED, draw_paths, draw_pushes, draw_snapshots
from .text_escaping import for_figure

STEPS = 6.0  # last steps whose balance is shown
BEFORE, AFTER = 1.0, 4.0  # time shown before and after a push, in [s]
MAX_SAMPLES = 1500  # of a curve of clearance, approximately
COLUMNS = 5  # of the legend of many players
MOST_CURVES = 10  # of distances between pairs; beyond, the nearest of each
RUNS = ("#222222", *LIGHT.others)  # colours of compared runs
PERSONAL, SOCIAL = 0.45, 1.2  # limits of personal and social space, in [m]
Draw = Callable[[Any], None]


def draw_run(run: Run, file: AnyPath) -> None:
    """Write the figure of a game of any kind, in the format of the suffix."""
    rows, heights, drawn = _layout_of(run)
    number = len(run.players)
    many = number > 2
    curves = number * (number - 1) // 2
    if curves > MOST_CURVES:
        curves = len(run.deciding or run.players)
    lines = -(-(number + curves) // COLUMNS) if many else 0
    figure, axes = panels(
        rows,
        11.0,
        heights,
        title=f"{_title(run)}: {for_figure(run.message)}",
        legend=lines,
        right=0.95,
    )
    paths = axes["p"]
    draw_paths(paths, run)
    if many:
        paths.set_title(paths.get_title(), pad=6)
    else:
        legend_above(paths, paths.get_title(), 2)
    if "0" in axes:
        # Quadratic spacing, since more happens early.
        times = (np.arange(4) / 3.0) ** 2 * run.times[-1]
        draw_snapshots([axes[letter] for letter in "0123"], run, times)
    for letter, draw in drawn.items():
        draw(axes[letter])
    if many:
        legend_below(figure, [paths, axes["d"]], ncols=COLUMNS)
    save(figure, file)


def _title(run: Run) -> str:
    """Return the title of a run."""
    settings = run.settings
    if run.game == "play":
        return f"Play of the {settings.role} over {settings.language}"
    if run.game == "experiment":
        return f"Experiment {settings.source}"
    title = f"{run.game.capitalize()}, seed {settings.seed}"
    robots = {n: Path(settings.player(n).robot).name for n in settings.robots}
    if len({*robots.values()}) < 2:
        return title
    return f"{title} ({', '.join(map(' '.join, robots.items()))})"


def _layout_of(run: Run) -> tuple[list[str], list[float], dict[str, Draw]]:
    """Return rows of panels, their heights [inch], and what draws each."""
    walkers = [n for n, t in run.tracks.items() if t.zmp_reference is not None]
    if run.game == "play":
        name = run.settings.role
        commanded = run.tracks[name].command is not None
        lower = _draw_command if commanded else _draw_balance
        return (
            ["ppdd", "ppaa", "ppcc"],
            [1.3, 1.3, 1.3],
            {
                "d": partial(_draw_sightings, run, name, 2),
                "a": partial(_draw_sightings, run, name, 1),
                "c": partial(lower, run, name),
            },
        )
    below: dict[str, Draw] = {}
    if run.plan is not None and (run.plan.solids or run.plan.moving):
        below = {"b": partial(_draw_clearance, run, run.plan)}
    elif len(run.players) == 1 and walkers:
        below = {"b": partial(_draw_balance, run, walkers[0])}
    elif len(run.players) == 2:
        below = {
            letter: partial(_draw_balance, run, name)
            for letter, name in zip("bc", walkers, strict=False)
        }
    if len(run.players) == 1:
        rows, heights, drawn = ["pppp"], [2.0], dict[str, Draw]()
        (track,) = run.tracks.values()
        if track.tilt is not None:
            rows, heights = [*rows, "tttt"], [*heights, 1.1]
            drawn = {"t": partial(_draw_tilt, run)}
    elif len(run.players) == 2:
        rows, heights = ["0123", "ppdd", "ppaa"], [1.6, 1.25, 1.25]
        drawn = {
            "d": partial(_draw_measure, run, angle=False),
            "a": partial(_draw_measure, run, angle=True),
        }
    else:
        rows, heights = ["0123", "ppdd"], [1.7, 3.8]
        drawn = {"d": partial(_draw_distances, run)}
    if below:
        letters = "".join(below)
        rows = [*rows, "bbcc" if letters == "bc" else "bbbb"]
        heights = [*heights, 1.4]
    return rows, heights, drawn | below


def _draw_measure(run: Run, axes: Any, *, angle: bool) -> None:
    """Draw distance or angle between headings, with the theory's value."""
    values = run.orientation if angle else run.distance
    times, theory = run.times, run.theory
    axes.plot(times, values, color=SWAY, lw=0.8, label="every sample")
    mean = whole_cycles(values, times, run.settings.cycle)
    axes.plot(times, mean, color=MEAN, lw=1.6, label="mean over a gait cycle")
    level = theory and theory[2 if angle else 1]
    areas = () if angle else safety_areas(run).items()
    for name, radius in areas:
        # The label of the higher line is above it, the other below.
        va = "bottom" if level is not None and level <= radius else "top"
        colour = colours_of(run)[name]
        text = f"safety radius\n{radius:.3g} m"
        mark_level(axes, radius, text, colour, ":", va=va)
    if level is not None:
        higher = all(level > radius for _, radius in areas)
        va = "center" if not areas else "bottom" if higher else "top"
        unit = "°" if angle else " m"
        mark_level(axes, level, f"theory {level:.3g}{unit}", THEORY, va=va)
    _mark_pushes(axes, run)
    axes.set_ylabel(
        "angle between\nheadings [deg]" if angle else "distance [m]"
    )
    axes.margins(x=0.0)
    axes.set_xlabel("time [s]")
    if not angle:
        legend_above(axes, "distance between the players", 3)


def _mark_pushes(axes: Any, run: Run) -> None:
    """Mark the times of all pushes of a run in a plot over time."""
    label: str | None = "push"
    for track in run.tracks.values():
        for push in () if track.pushes is None else track.pushes:
            axes.axvline(push[0], color=PUSHED, ls=":", lw=1.0, label=label)
            label = None


def _draw_balance(run: Run, name: str, axes: Any) -> None:
    """Draw CoM and ZMP to the left, around the first push or at the end.

    References are in odometry, true values in the world, so that each are
    relative to their own mean.
    """
    times, track = run.times, run.tracks[name]
    com, zmp = track.com[:, :2], track.zmp
    zmp_reference, com_reference = track.zmp_reference, track.com_reference
    assert zmp is not None and zmp_reference is not None
    assert com_reference is not None
    last, when = float(times[-1]), "last steps"
    if track.landings is not None and len(track.landings):
        last = min(last, float(track.landings[-1, 0]))
    first = last - 0.5 * STEPS * run.settings.cycle
    if track.pushes is not None:
        push = float(track.pushes[0, 0])
        first, last, when = push - BEFORE, push + AFTER, "around the push"
    show = (times >= first) & (times <= last)
    heading = float(track.torso[show][:, 2].mean())
    axis = np.array([-np.sin(heading), np.cos(heading)])
    colour = colours_of(run)[name]
    for label, points, middle, look in (
        ("ZMP", zmp, com, {"color": "#a0a0a0", "lw": 0.8}),
        (
            "ZMP reference",
            zmp_reference,
            com_reference,
            {"color": THEORY, "lw": 1.2},
        ),
        ("CoM", com, com, {"color": colour, "lw": 2.0}),
        # Dashed and on top, so that both are visible where they coincide.
        (
            "CoM reference",
            com_reference,
            com_reference,
            {"color": "#e0a400", "lw": 1.2, "ls": (0, (3, 2))},
        ),
    ):
        across = (points[show, :2] - middle[show].mean(axis=0)) @ axis
        axes.plot(times[show], 1e3 * across, label=label, **look)
    _mark_pushes(axes, run)
    axes.set_xlim(times[show][0], max(times[show][-1], times[show][0] + 0.02))
    axes.set(xlabel="time [s]", ylabel="leftward [mm]")
    legend_above(axes, f"{name}: balance, {when}", 5)


def _draw_tilt(run: Run, axes: Any) -> None:
    """Draw the tilt of the torso of a walk."""
    (track,) = run.tracks.values()
    assert track.tilt is not None
    leans = zip(("roll", "pitch"), (LEFT, RIGHT), track.tilt.T, strict=True)
    for lean, colour, values in leans:
        look: dict[str, Any] = {"color": colour, "lw": 1.0, "label": lean}
        axes.plot(run.times, np.degrees(values), **look)
    _mark_pushes(axes, run)
    axes.set(xlabel="time [s]", ylabel="tilt [deg]")
    axes.margins(x=0.0)
    legend_above(axes, "torso", 3)


def clearance_of(room: Room, places: Array, times: Array) -> Array:
    """Return the distance to the nearest wall or obstacle, in [m].

    It is negative inside. Places are (x, y), in [m], shape (n, 2), at times
    in [s], shape (n,).
    """
    found = room.clearance(places)
    for mover in room.moving:
        moved = [
            float(mover.at(time).clearance([place])[0])
            for place, time in zip(places, times.tolist(), strict=True)
        ]
        found = np.minimum(found, moved)
    return found


def _draw_clearance(run: Run, room: Room, axes: Any) -> None:
    """Draw each player's clearance over time."""
    every = slice(None, None, max(1, len(run.times) // MAX_SAMPLES))
    for name, colour in colours_of(run).items():
        places = run.tracks[name].unicycle[every, :2]
        clearance = clearance_of(room, places, run.times[every])
        axes.plot(run.times[every], clearance, color=colour, label=name)
    text = f"body radius\n{BODY_RADIUS:.3g} m"
    mark_level(axes, BODY_RADIUS, text, THEORY, va="top")
    axes.set(xlabel="time [s]", ylabel="clearance [m]")
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    axes.margins(x=0.0)
    title = "distance to the nearest wall or obstacle"
    if len(run.players) > 2:  # named below the figure
        axes.set_title(title)
    else:
        legend_above(axes, title, 5)


def _draw_distances(run: Run, axes: Any) -> None:
    """Draw the distance of each pair, or of each player to the nearest."""
    colours = colours_of(run)
    markers = markers_of(run.tracks)
    for number, (label, name, other, values) in enumerate(_curves_of(run)):
        axes.plot(
            run.times,
            whole_cycles(values, run.times, run.settings.cycle),
            color=colours[name],
            ls=LINES[number % len(LINES)],
            marker=markers[other or name],
            markevery=max(1, len(run.times) // MARKED),
            ms=4.5,
            lw=1.3,
            label=label,
        )
        nearest = int(values.argmin())
        closest = run.times[nearest], values[nearest]
        axes.plot(*closest, "x", color=colours[name])
    if run.game == "game" and run.persons:
        for limit in (PERSONAL, SOCIAL):
            mark_level(axes, limit, f"{limit:g} m", "#888888", ":")
    axes.set(xlabel="time [s]", ylabel="distance [m]")
    axes.set_ylim(bottom=0.0)
    axes.margins(x=0.0)
    axes.set_title("distances, mean over a gait cycle; cross: closest")


def _curves_of(run: Run) -> list[tuple[str, str, str, Array]]:
    """Return label, player, other player and distance of each curve."""
    tracks = {name: track.unicycle for name, track in run.tracks.items()}
    pairs = [*combinations(run.players, 2)]
    apart = {
        pair: distance_between(tracks[pair[0]], tracks[pair[1]])
        for pair in pairs
    }
    if len(pairs) <= MOST_CURVES:
        return [
            (f"{one} - {other}", one, other, values)
            for (one, other), values in apart.items()
        ]
    found = []
    for name in run.deciding or run.players:
        own = [values for pair, values in apart.items() if name in pair]
        found.append((f"{name} - nearest", name, "", np.min(own, axis=0)))
    return found


def _draw_sightings(run: Run, name: str, column: int, axes: Any) -> None:
    """Draw measured bearing (1) or distance (2) of a player's opponent."""
    sight = run.tracks[name].sight
    if sight is not None:
        values = sight[:, 2] if column == 2 else np.degrees(sight[:, 1])
        axes.plot(sight[:, 0], values, color=MEAN, lw=1.2)
    if column == 2:
        for radius in safety_areas(run).values():
            text = f"safety radius\n{radius:.3g} m"
            mark_level(axes, radius, text, THEORY, ":")
        axes.set_title("sightings of the opponent; grey lines: state changes")
    _mark_changes(axes, run)
    axes.set_ylabel("distance [m]" if column == 2 else "bearing [deg]")


def _draw_command(run: Run, name: str, axes: Any) -> None:
    """Draw the desired velocity and the command that was sent."""
    command = run.tracks[name].command
    assert command is not None
    colour = colours_of(run)[name]
    turns = axes.twinx()
    for part, label, look in ((0, "desired", ":"), (3, "command", "-")):
        speed, turn = command[:, part], command[:, part + 1]
        axes.plot(run.times, speed, color=colour, ls=look, label=label)
        turns.plot(run.times, turn, color=SWAY, ls=look, lw=0.9)
    axes.set(xlabel="time [s]", ylabel="forward [m/s]")
    turns.set_ylabel("turning rate [rad/s], pale")
    _mark_changes(axes, run)
    legend_above(axes, "velocity", 2)


def _mark_changes(axes: Any, run: Run) -> None:
    """Mark the changes of the robot's state."""
    play = run.summary.play
    for change in play.changes[:50] if play else ():
        axes.axvline(change.time_s, color="#c0c0c0", lw=0.6)
    axes.set_xlim(0.0, max(0.02, float(run.times[-1])))


def draw_runs(runs: Sequence[Run], file: AnyPath) -> None:
    """Draw paths and, over gait cycles, what several runs have in common.

    Of games, that is the distance and, of two players, the angle between
    the headings, with theory dotted; of walks, tilt and speed.

    Args:
        runs: The runs; each has its own line style. Paths have the colours
            of the players if styles suffice to tell the runs apart.
        file: Figure to write; its suffix gives the format.
    """
    walks = all(len(run.players) == 1 for run in runs)
    plays = all(run.game == "play" for run in runs)
    by_player = plays or (not walks and len(runs) <= len(LINES))
    turned = any(run.has_orientation for run in runs)
    rows = ["pd", "pa"] if turned or walks else ["pd"]
    heights = [1.9] * len(rows) if len(rows) > 1 else [3.6]
    lines = -(-len(runs) // 3)
    figure, axes = panels(rows, 9.5, heights, legend=lines)
    for number, run in enumerate(runs):
        line, colour = LINES[number % len(LINES)], RUNS[number % len(RUNS)]
        colours = dict.fromkeys(run.tracks, colour)
        if by_player:
            colours = colours_of(run)
        if plays:
            colour = colours[run.settings.role]
        look: dict[str, Any] = {"ls": line, "lw": 1.1}
        for name, track in run.tracks.items():
            axes["p"].plot(*track.torso[:, :2].T, color=colours[name], **look)
            draw_pushes(axes["p"], track.pushes)
        values = (
            _walk_measures(run)
            if walks
            else (
                whole_cycles(each, run.times, run.settings.cycle)
                for each in (run.distance, run.orientation)
            )
        )
        levels = run.theory[1:] if run.theory else (None, None)
        for key, each, level in zip("da", values, levels, strict=True):
            if key in axes:
                label = for_figure(run.name)
                look["color"] = colour
                axes[key].plot(run.times, each, label=label, **look)
                if level is not None:
                    axes[key].axhline(level, color=colour, ls=":", lw=0.8)
    axes["p"].set_aspect("equal", adjustable="datalim")
    title = "paths of the torsos" + ", each in its odometry" * plays
    axes["p"].set(title=title, xlabel="x [m]", ylabel="y [m]")
    labels = ("distance [m]", "angle between headings [deg]")
    if walks:
        labels = ("tilt [deg]", "speed [m/s]")
    for key, label in zip("da", labels, strict=True):
        if key in axes:
            axes[key].set(xlabel="time [s]", ylabel=label)
    legend_below(figure, [axes["d"]], ncols=3)
    save(figure, file)


def _walk_measures(run: Run) -> tuple[Array, Array]:
    """Return tilt [deg], and speed over the gait cycle around, in [m/s]."""
    (track,) = run.tracks.values()
    tilt, speed = np.full((2, len(run.times)), np.nan)
    if track.tilt is not None:
        tilt = np.degrees(np.hypot(*track.tilt.T))
    half = max(1, int(np.searchsorted(run.times, 0.5 * run.settings.cycle)))
    if len(run.times) > 2 * half:
        way = track.unicycle[2 * half :, :2] - track.unicycle[: -2 * half, :2]
        passed = run.times[2 * half :] - run.times[: -2 * half]
        speed[half:-half] = np.hypot(*way.T) / passed
    return tilt, speed
