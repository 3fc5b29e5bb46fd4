"""Figure of a game of unicycles in the manner of the paper's Fig. 2."""

from typing import Any

import numpy as np

from ..core.poses import Array
from ..theory.unicycle.adaptive_simulation import PlayedGame
from ..theory.unicycle.circles import circle_of
from .figure_style import EVADER, PURSUER, new_figure, save

TICK = 0.5  # [m], as in Fig. 2
_FRACTIONS = (0.0, 0.12, 0.4, 1.0)  # of the time shown


def time_shown(run: PlayedGame) -> float:
    """Return the time of the last snapshot of a game, in [s].

    Five time constants of the circle and one revolution, at most the whole
    game.
    """
    circle = circle_of(run.game)
    if not (circle.exists and circle.stable):
        return run.end_time
    turn = 2.0 * np.pi / circle.turning_rate_rad_s
    return min(run.end_time, 5.0 * circle.time_constant_s + turn)


def draw_game(run: PlayedGame, path: str) -> None:
    """Write four snapshots of a game, ticks 0.5 m apart.

    Args:
        run: The game.
        path: File to write; its suffix gives the format.
    """
    times = np.linspace(0.0, time_shown(run), 1200)
    pursuer, evader = run.poses(times)
    both = np.vstack([pursuer[:, :2], evader[:, :2]])
    middle = 0.5 * (both.min(axis=0) + both.max(axis=0))
    half = 0.55 * float(np.ptp(both, axis=0).max()) + TICK
    figure = new_figure(7.4, 7.6)
    axes = figure.subplots(2, 2, sharex=True)
    for ax, fraction in zip(axes.flat, _FRACTIONS, strict=True):
        end = max(1, round(fraction * len(times)))
        _draw_paths(ax, pursuer[:end], evader[:end], 0.06 * half)
        ax.set_title(f"t = {times[end - 1]:.1f} s")
        ax.set_aspect("equal")
        ax.set_xlim(middle[0] - half, middle[0] + half)
        ax.set_ylim(middle[1] - half, middle[1] + half)
        if half < 40.0 * TICK:  # more ticks would merge
            ax.set_xticks(_ticks(middle[0], half), minor=True)
            ax.set_yticks(_ticks(middle[1], half), minor=True)
            ax.grid(which="minor", alpha=0.15)
    for ax in axes[-1]:
        ax.set_xlabel("x [m]")
    for ax in axes[:, 0]:
        ax.set_ylabel("y [m]")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    figure.suptitle("Pursuer and evader; ticks are 0.5 m apart")
    save(figure, path)


def _ticks(middle: float, half: float) -> Array:
    low, high = np.ceil((middle - half) / TICK), (middle + half) / TICK
    ticks: Array = TICK * np.arange(low, high)
    return ticks


def _draw_paths(ax: Any, pursuer: Array, evader: Array, size: float) -> None:
    """Draw both paths with the players at their ends."""
    players = (
        ("pursuer", pursuer, PURSUER, "-"),
        ("evader", evader, EVADER, "--"),
    )
    for name, poses, colour, line in players:
        ax.plot(poses[:, 0], poses[:, 1], line, color=colour, lw=1.2)
        x, y, theta = poses[-1]
        body = np.array([[1.4, 0], [-0.8, 0.8], [-0.8, -0.8]]) * size
        c, s = np.cos(theta), np.sin(theta)
        corners = body @ np.array([[c, s], [-s, c]]) + (x, y)
        ax.fill(corners[:, 0], corners[:, 1], color=colour, label=name)
    sight = np.vstack([pursuer[-1, :2], evader[-1, :2]])
    ax.plot(sight[:, 0], sight[:, 1], ":", color="0.5", lw=0.8)
