"""Figure of the circle over evasion angle, gain ratio and speed ratio."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..theory.unicycle.adaptive_simulation import simulate
from ..theory.unicycle.circle_fit import FittedCircle, measure, settling_time
from ..theory.unicycle.circles import circle_of
from ..theory.unicycle.relative_coordinates import RelativeStart
from ..theory.unicycle.unicycle_game import Game, SideRule, TurningLaw
from .figure_sizes import sheet
from .figure_style import LEFT, RIGHT, THEORY, new_figure, save

_STYLES = {
    TurningLaw.PROPORTIONAL: ("-", "o", LEFT),
    TurningLaw.SATURATED: ("--", "s", RIGHT),
}


class ParameterSweep(NamedTuple):
    """Range of one parameter.

    Attributes:
        label: Name of the parameter, with its unit.
        low: Smallest value.
        high: Largest value.
        vary: Function that returns the game with a value.
    """

    label: str
    low: float
    high: float
    vary: Callable[[Game, float], Game]


def _with_gain(game: Game, ratio: float) -> Game:
    """Return the game with a ratio of the evader's to the pursuer's gain."""
    evader = replace(game.evader, gain=ratio * game.pursuer.gain)
    return replace(game, evader=evader)


def _with_speed(game: Game, ratio: float) -> Game:
    """Return the game with a ratio of the pursuer's to the evader's speed."""
    pursuer = replace(game.pursuer, speed=ratio * game.evader.speed)
    return replace(game, pursuer=pursuer)


_SWEEPS = (
    ParameterSweep(
        "evasion angle [rad]", 0.15, 3.0, lambda g, x: replace(g, angle=x)
    ),
    ParameterSweep("evader's gain / pursuer's gain [1]", 0.4, 2.5, _with_gain),
    ParameterSweep(
        "pursuer's speed / evader's speed [1]", 0.4, 1.6, _with_speed
    ),
)


def draw_sweep(game: Game, path: str, *, marks: int = 7) -> None:
    """Write radius and distance over angle, gain ratio and speed ratio.

    Args:
        game: Game whose parameters are varied one at a time.
        path: File to write; its suffix gives the format.
        marks: Number of simulated games along each line.
    """
    figure = new_figure(10.0, 5.6)
    axes = figure.subplots(2, 3, sharex="col", sharey="row")
    for column, sweep in zip(axes.T, _SWEEPS, strict=True):
        for law in TurningLaw:
            _draw_lines(column, game, sweep, law)
            _draw_marks(column, game, sweep, law, marks)
        column[1].set_xlabel(sweep.label)
    axes[0, 0].set_ylabel("radius of the pursuer's circle [m]")
    axes[1, 0].set_ylabel("distance between the players [m]")
    unit = game.evader.speed / game.evader.gain
    for ax in axes[:, 0]:
        ax.set_ylim(0.0, 6.0 * unit)
    figure.legend(
        *axes[0, 2].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=2 if sheet().narrow else 4,
    )
    figure.suptitle(
        "Circle at the end of a game: equations (lines), simulation (marks)"
    )
    save(figure, path)


def _draw_lines(
    axes: Any, game: Game, sweep: ParameterSweep, law: TurningLaw
) -> None:
    """Draw radius and distance of the equations into a column of axes."""
    line, _, colour = _STYLES[law]
    xs = np.linspace(sweep.low, sweep.high, 200)
    games = [replace(sweep.vary(game, float(x)), law=law) for x in xs]
    circles = [circle_of(varied) for varied in games]
    radii = [c.radius_pursuer_m for c in circles]
    distances = [c.distance_m for c in circles]
    axes[0].plot(xs, radii, line, color=colour, label=f"{law}, equations")
    axes[1].plot(xs, distances, line, color=colour)


def _draw_marks(
    axes: Any, game: Game, sweep: ParameterSweep, law: TurningLaw, count: int
) -> None:
    """Draw the circles of simulated games, where a stable circle exists."""
    _, mark, colour = _STYLES[law]
    found = []
    for x in np.linspace(sweep.low, sweep.high, count).tolist():
        ends = simulate_circle(replace(sweep.vary(game, x), law=law))
        if ends is not None:
            found.append((x, ends.radius_pursuer_m, ends.distance_m))
    if not found:
        return
    look = {"ms": 4, "mec": THEORY, "mfc": colour}
    xs, radii, distances = np.array(found).T
    axes[0].plot(xs, radii, mark, label=f"{law}, simulated", **look)
    axes[1].plot(xs, distances, mark, **look)


def simulate_circle(game: Game) -> FittedCircle | None:
    """Return the circle at the end of a game that starts near it.

    None if it is not stable or the evader is captured.
    """
    circle = circle_of(game)
    if not (circle.exists and circle.stable):
        return None
    start = RelativeStart(
        1.2 * circle.distance_m,
        circle.pursuer_error_rad,
        circle.evader_error_rad - game.angle,
    )
    # With a latched side: near the circle the side rule has no effect.
    kept = replace(game, side_rule=SideRule.LATCHED, hysteresis=0.0)
    played = simulate(kept, start, settling_time(game), side=1)
    return None if played.captured else measure(played)
