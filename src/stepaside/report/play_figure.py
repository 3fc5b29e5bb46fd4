"""Figure of a run on a robot: path, sightings and commands or balance."""

from pathlib import Path
from typing import Any

import numpy as np

from ..games.run import PlayRun
from ..games.trajectory import Trajectory
from .duel_figure import draw_paths
from .figure_style import MEAN, SWAY, THEORY, colours_of, new_figure, save
from .text_escaping import for_figure

STEPS = 6.0  # last steps whose balance is shown


def draw_play(run: PlayRun, path: Path) -> None:
    """Write the figure of a run on a robot.

    Args:
        run: The run.
        path: File to write; its suffix gives the format.
    """
    figure = new_figure(11.0, 6.4)
    left, right = figure.subfigures(1, 2, width_ratios=[1.0, 1.15])
    draw_paths(left.add_subplot(), run)
    upper, middle, lower = right.subplots(3, 1)
    _draw_distance(upper, run)
    _draw_bearing(middle, run)
    if _own(run).command is not None:
        _draw_command(lower, run)
    else:
        _draw_balance(lower, run)
    figure.suptitle(f"{run.title}: {for_figure(run.message)}")
    save(figure, path)


def _draw_distance(axes: Any, run: PlayRun) -> None:
    """Draw the measured distance of the opponent and the safety radius."""
    sight = _own(run).sight
    if sight is not None:
        axes.plot(sight[:, 0], sight[:, 2], color=MEAN, lw=1.2)
    if run.safety is not None:
        axes.axhline(run.safety.radius, color=THEORY, ls=":", lw=1.0)
    _mark_changes(axes, run)
    axes.set_ylabel("distance [m]")
    axes.set_title("sightings of the opponent; grey lines: state changes")


def _draw_bearing(axes: Any, run: PlayRun) -> None:
    sight = _own(run).sight
    if sight is not None:
        axes.plot(sight[:, 0], np.degrees(sight[:, 1]), color=MEAN, lw=1.2)
    _mark_changes(axes, run)
    axes.set_ylabel("bearing [deg]")


def _draw_command(axes: Any, run: PlayRun) -> None:
    """Draw the desired velocity and the command that was sent."""
    command = _own(run).command
    assert command is not None
    colour = colours_of(run.players, run.identities)[run.settings.role]
    turns = axes.twinx()
    for part, name, look in ((0, "desired", ":"), (3, "command", "-")):
        speed, turn = command[:, part], command[:, part + 1]
        axes.plot(run.times, speed, color=colour, ls=look, label=name)
        turns.plot(run.times, turn, color=SWAY, ls=look, lw=0.9)
    axes.set(xlabel="time [s]", ylabel="forward [m/s]")
    turns.set_ylabel("turning rate [rad/s], pale")
    _mark_changes(axes, run)
    axes.legend(ncols=2, loc="lower right")


def _draw_balance(axes: Any, run: PlayRun) -> None:
    """Draw CoM and ZMP during the last steps of the walk, leftward."""
    track, times = _own(run), run.times
    landings = track.landings
    last = times[-1]
    if landings is not None and len(landings):
        last = min(last, float(landings[-1, 0]))
    span = STEPS * run.settings.gait.step_duration
    show = (times >= last - span) & (times <= last)
    heading = float(track.torso[show][:, 2].mean())
    across = np.array([-np.sin(heading), np.cos(heading)])
    middle = track.com[show, :2].mean(axis=0)
    lines = (
        ("ZMP", track.zmp, {"color": "#a0a0a0", "lw": 0.8}),
        ("ZMP reference", track.zmp_reference, {"color": THEORY, "lw": 1.2}),
        ("CoM", track.com, {"color": MEAN, "lw": 1.8}),
        ("CoM reference", track.com_reference, {"color": "#e0a400", "lw": 1}),
    )
    for name, points, look in lines:
        assert points is not None
        aside = 1e3 * (points[show, :2] - middle) @ across
        axes.plot(times[show], aside, label=name, **look)
    axes.set(xlabel="time [s]", ylabel="leftward [mm]")
    axes.margins(x=0.0)
    axes.set_title("last steps, measured and estimated", pad=18)
    axes.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 0.97))


def _own(run: PlayRun) -> Trajectory:
    """Return the trajectory of the player itself."""
    return run.tracks[run.settings.role]


def _mark_changes(axes: Any, run: PlayRun) -> None:
    """Mark the changes of the robot's state."""
    for change in run.summary.changes[:50]:
        axes.axvline(change.time_s, color="#c0c0c0", lw=0.6)
    axes.set_xlim(0.0, max(0.02, float(run.times[-1])))
