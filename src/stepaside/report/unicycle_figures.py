"""Figures of games of unicycles: a game, sweeps and maps of its circles."""

from collections.abc import Callable
from dataclasses import replace
from string import ascii_letters as LETTERS
from typing import Any

import numpy as np
from matplotlib.colors import ListedColormap

from ..core.errors import AnyPath
from ..core.poses import Array
from ..theory.unicycle.circles import Circle, circle_of, settling_time
from ..theory.unicycle.simulation import (
    FittedCircle,
    PlayedGame,
    RelativeStart,
    measure,
    simulate,
)
from ..theory.unicycle.start_maps import StartMap
from ..theory.unicycle.unicycle_game import LAWS, Unicycles
from .figure_style import (
    COLOURS,
    LEFT,
    RIGHT,
    THEORY,
    legend_below,
    panels,
    save,
)
from .plan_view import draw_heading
from .result_labels import CIRCLES

TICK = 0.5  # [m], as in Fig. 2
_FRACTIONS = (0.0, 0.12, 0.4, 1.0)  # of the time shown
# Colours of Okabe and Ito, distinct with colour blindness, too.
_COLOURS = ("#f0e442", "#0072b2", "#cc79a7", "#d55e00", "#009e73", "#56b4e9")
_STYLES = {
    LAWS[0]: ("-", "o", LEFT),
    LAWS[1]: ("--", "s", RIGHT),
}


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


def draw_game(run: PlayedGame, path: AnyPath) -> None:
    """Write four snapshots of a game in the manner of the paper's Fig. 2."""
    times = np.linspace(0.0, time_shown(run), 1200)
    poses = run.poses(times)
    both = np.vstack([own[:, :2] for own in poses])
    middle = 0.5 * (both.min(axis=0) + both.max(axis=0))
    half = 0.55 * float(np.ptp(both, axis=0).max()) + TICK
    figure, axes = panels(
        ["ab", "cd"],
        7.4,
        [3.0, 3.0],
        title="Pursuer and evader; fine lines are 0.5 m apart",
        legend=1,
    )
    for ax, fraction in zip(axes.values(), _FRACTIONS, strict=True):
        end = max(1, round(fraction * len(times)))
        for (name, colour), own, line in zip(
            COLOURS.items(), poses, ("-", "--"), strict=True
        ):
            ax.plot(*own[:end, :2].T, line, color=colour, lw=1.2, label=name)
            draw_heading(ax, own[end - 1], colour, 0.16 * half)
        sight = np.vstack([own[end - 1, :2] for own in poses])
        ax.plot(*sight.T, ":", color="0.5", lw=0.8)
        ax.set(title=f"t = {times[end - 1]:.1f} s", aspect="equal")
        ax.set(xlabel="x [m]", ylabel="y [m]")
        ax.set_xlim(middle[0] - half, middle[0] + half)
        ax.set_ylim(middle[1] - half, middle[1] + half)
        if half < 40.0 * TICK:  # more ticks would merge
            ax.set_xticks(_ticks(middle[0], half), minor=True)
            ax.set_yticks(_ticks(middle[1], half), minor=True)
            ax.grid(which="minor", alpha=0.15)
    legend_below(figure, [axes["a"]], ncols=2)
    save(figure, path)


def _ticks(middle: float, half: float) -> Array:
    low, high = np.ceil((middle - half) / TICK), (middle + half) / TICK
    ticks: Array = TICK * np.arange(low, high)
    return ticks


# Label, lowest and highest value of a parameter.
_SWEEPS: tuple[
    tuple[str, float, float, Callable[[Unicycles, float], Unicycles]], ...
] = (
    ("evasion angle [rad]", 0.15, 3.0, lambda g, x: replace(g, angle=x)),
    (
        *("evader's gain / pursuer's gain [1]", 0.4, 2.5),
        lambda g, x: replace(g, evader_gain=x * g.pursuer_gain),
    ),
    (
        *("pursuer's speed / evader's speed [1]", 0.4, 1.6),
        lambda g, x: replace(g, pursuer_speed=x * g.evader_speed),
    ),
)


def draw_sweep(game: Unicycles, path: AnyPath) -> None:
    """Write radius and distance over angle, gain ratio and speed ratio.

    The parameters of the game are varied one at a time.
    """
    figure, axes = panels(
        ["abc", "def"],
        10.0,
        [2.0, 2.0],
        title="Circle at the end of a game: equations (lines), simulation "
        "(marks)",
        legend=1,
        gaps=(0.3, 0.2),
    )
    here = circle_of(game)
    unit = game.evader_speed / game.evader_gain
    high = 3.3 * here.distance_m if here.exists else 6.0 * unit
    for over, under, sweep in zip("abc", "def", _SWEEPS, strict=True):
        label, lowest, highest, vary = sweep
        for law in LAWS:
            line, mark, colour = _STYLES[law]
            own = replace(game, law=law)
            xs = np.linspace(lowest, highest, 200).tolist()
            circles = [circle_of(vary(own, x)) for x in xs]
            ends = [
                (x, end)
                for x in np.linspace(lowest, highest, 7).tolist()
                if (end := simulate_circle(vary(own, x))) is not None
            ]
            look: dict[str, Any] = {"ms": 4, "mec": THEORY, "mfc": colour}
            for letter, name in (
                (over, "radius_pursuer_m"),
                (under, "distance_m"),
            ):
                lines = [getattr(circle, name) for circle in circles]
                named = {"label": f"{law}, equations"}
                axes[letter].plot(xs, lines, line, color=colour, **named)
                points = [(x, getattr(end, name)) for x, end in ends]
                if points:
                    columns = zip(*points, strict=True)
                    named = {"label": f"{law}, simulated"}
                    axes[letter].plot(*columns, mark, **look, **named)
        axes[under].set(xlabel=label, ylim=(0.0, high))
        axes[over].set(ylim=(0.0, high))
        axes[over].tick_params(labelbottom=False)
    axes["a"].set_ylabel("radius of the\npursuer's circle [m]")
    axes["d"].set_ylabel("distance between\nthe players [m]")
    legend_below(figure, [axes["c"]], ncols=4)
    save(figure, path)


def simulate_circle(game: Unicycles) -> FittedCircle | None:
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
    kept = replace(game, side_rule="latched", hysteresis=0.0)
    played = simulate(kept, start, settling_time(game), side=1)
    return None if played.captured else measure(played)


def draw_map(
    found: StartMap, path: AnyPath, *, circles: tuple[Circle, ...], body: float
) -> None:
    """Draw closest approach, settling time and circle over the bearings.

    Grey is where the evader is captured or the game does not settle. At most
    four distances are drawn; if there are several circles, the one that each
    game ends on, too. The capture distance is drawn as a line, in [m].
    """
    distances, aims, bearings = found.axes
    aims, bearings = np.rad2deg(aims), np.rad2deg(bearings)
    wide = min(4, len(distances))
    picks = np.linspace(0, len(distances) - 1, wide).astype(int)
    closest, settled = map(found.grid, ("closest_distance", "settled_time"))
    settled = np.where(np.isfinite(settled), settled, np.nan)
    drawn: list[tuple[Array, str, dict[str, Any]]] = [
        (closest, "closest approach [m]", {"cmap": "viridis", "vmin": 0.0}),
        (
            settled,
            "time to reach the circle [s]",
            {"cmap": "cividis", "vmin": 0.0},
        ),
    ]
    if len(circles) > 1:
        numbers = found.grid("circle").astype(float)
        numbers[numbers < 0.0] = np.nan
        look = {"cmap": ListedColormap(_COLOURS[: len(circles)]), "vmin": -0.5}
        look["vmax"] = len(circles) - 0.5
        drawn.append((numbers, "circle, distance [m]", look))
    rows = [LETTERS[wide * i : wide * (i + 1)] for i in range(len(drawn))]
    figure, axes = panels(
        rows,
        2.7 * wide + 1.7,
        [1.9] * len(rows),
        right=0.9,
        gaps=(0.45, 0.4),
        sharex=True,
        sharey=True,
    )
    for row, (values, label, look) in zip(rows, drawn, strict=True):
        found_any = np.isfinite(values).any()
        look.setdefault("vmax", np.nanmax(values) if found_any else 1.0)
        for letter, i in zip(row, picks, strict=True):
            image = axes[letter].pcolormesh(bearings, aims, values[i], **look)
            axes[letter].set_facecolor("0.8")
            axes[letter].grid(visible=False)
            if closest[i].min() <= body < closest[i].max():
                level = [1.001 * body]
                axes[letter].contour(
                    bearings, aims, closest[i], level, colors="w"
                )
        shown = [axes[letter] for letter in row]
        bar = figure.colorbar(image, ax=shown, label=label, fraction=0.03)
        axes[row[0]].set_ylabel("bearing of evader [deg]")
    if len(circles) > 1:
        texts = [
            f"{CIRCLES[c.direction]}\n{c.distance_m:.3g}" for c in circles
        ]
        bar.ax.set_yticks(range(len(circles)), texts)
    for over, under, i in zip(rows[0], rows[-1], picks, strict=True):
        axes[over].set_title(f"initial distance {distances[i]:.2f} m")
        axes[under].set_xlabel("bearing of pursuer [deg]")
    save(figure, path)
