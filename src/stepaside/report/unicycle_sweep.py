"""Figure of the circle over angle and ratios: theory line, simulated dots."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..unicycle.circling import circle_of
from ..unicycle.laws import Game, SideRule, TurningLaw
from ..unicycle.measure import measure, settling_time
from ..unicycle.relative import Start
from ..unicycle.simulate import simulate
from .style import EVADER, PURSUER, THEORY, plt

_STYLES = {
    TurningLaw.PROPORTIONAL: ("-", "o", EVADER),
    TurningLaw.SATURATED: ("--", "s", PURSUER),
}


def draw_sweep(game: Game, path: str, *, marks: int = 7) -> None:
    """Write radius and distance over angle, gain ratio and speed ratio.

    Args:
        game: Game about which is swept.
        path: File, of a format that its suffix tells.
        marks: Simulated games along each line.
    """
    sweeps: list[tuple[str, Any, Callable[[float], Game]]] = [
        (
            "evasion angle [rad]",
            (0.15, 3.0),
            lambda s: replace(game, angle=s),
        ),
        (
            "evader's gain / pursuer's gain",
            (0.4, 2.5),
            lambda s: replace(
                game, evader=replace(game.evader, gain=s * game.pursuer.gain)
            ),
        ),
        (
            "pursuer's speed / evader's speed",
            (0.4, 1.6),
            lambda s: replace(
                game,
                pursuer=replace(game.pursuer, speed=s * game.evader.speed),
            ),
        ),
    ]
    figure, axes = plt.subplots(
        2, 3, figsize=(10.0, 5.6), sharex="col", sharey="row"
    )
    for column, (label, (low, high), vary) in zip(axes.T, sweeps, strict=True):
        for law, style in _STYLES.items():
            _draw(column, low, high, marks, vary, law, style)
        column[1].set_xlabel(label)
    axes[0, 0].set_ylabel("radius of the pursuer [m]")
    axes[1, 0].set_ylabel("distance [m]")
    unit = game.evader.speed / game.evader.gain
    for ax in axes[:, 0]:
        ax.set_ylim(0.0, 6.0 * unit)
    axes[0, 2].legend(fontsize=8)
    figure.suptitle("Circle: equations (lines) and simulation (marks)")
    figure.savefig(path)
    plt.close(figure)


def _draw(
    axes: Any,
    low: float,
    high: float,
    marks: int,
    vary: Callable[[float], Game],
    law: TurningLaw,
    style: tuple[str, str, str],
) -> None:
    """Draw one line and its marks into a column of two axes."""
    line, mark, colour = style
    xs = np.linspace(low, high, 200)
    circles = [circle_of(replace(vary(float(x)), law=law)) for x in xs]
    radii = [c.radius_pursuer_m for c in circles]
    distances = [c.distance_m for c in circles]
    axes[0].plot(xs, radii, line, color=colour, label=f"{law}, equations")
    axes[1].plot(xs, distances, line, color=colour)
    found = []
    for x in np.linspace(low, high, marks).tolist():
        game = replace(vary(x), law=law)
        circle = circle_of(game)
        if not (circle.exists and circle.stable):
            continue
        start = Start(
            1.2 * circle.distance_m,
            circle.pursuer_error_rad,
            circle.evader_error_rad - game.angle,
        )
        # On a kept side: near the circle the rule behind changes nothing.
        kept = replace(game, side_rule=SideRule.LATCHED, hysteresis=0.0)
        run = simulate(kept, start, settling_time(game), side=1)
        measured = measure(run)
        found.append((x, measured.radius_pursuer_m, measured.distance_m))
    if found:
        x_marks, r_marks, d_marks = np.array(found).T
        axes[0].plot(
            x_marks, r_marks, mark, ms=4, mec=THEORY, mfc=colour,
            label=f"{law}, simulated",
        )  # fmt: skip
        axes[1].plot(x_marks, d_marks, mark, ms=4, mec=THEORY, mfc=colour)
