"""``stepaside theory map``: outcomes of games over their initial poses."""

from dataclasses import dataclass, replace
from math import pi, prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.entries import to_entries
from ..core.progress import show_progress
from ..core.ranges import Range
from ..core.setting import setting
from ..games.unicycle_settings import UnicycleGameSettings, positive
from ..report.result_labels import CIRCLES
from .options import figure_option, json_option
from .settings import takes_settings
from .tables import plain, print_rows, print_table, result_rows
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..theory.unicycle.start_maps import StartMap, WorstStart

NAMED = ("speed", "gain", "angle", "law", "nearest", "farthest", "grid")
HALF_TURN = Range(0.0, pi, "rad", "half a turn")
POINTS = Range(1, 400, "1", "more take hours", whole=True)


@dataclass(frozen=True, slots=True)
class StartMapSettings(UnicycleGameSettings):
    """Game, and the grid of its initial poses."""

    nearest: float | None = setting(
        None,
        "Minimum initial distance",
        positive("m", None),
        default_text="1.6 v/k",
    )
    farthest: float | None = setting(
        None,
        "Maximum initial distance",
        positive("m", None),
        default_text="4 v/k",
    )
    aim: float = setting(
        pi,
        "Maximum initial bearing of the evader in the pursuer's frame",
        HALF_TURN,
    )
    facing: float = setting(
        pi,
        "Maximum initial bearing of the pursuer in the evader's frame",
        HALF_TURN,
    )
    grid: int = setting(25, "Grid points along each bearing", POINTS)
    distances: int = setting(6, "Grid points along the distance", POINTS)
    duration: float | None = setting(
        None,
        "Simulated time of each game",
        positive("s", None),
        default_text="30/k",
    )
    step: float | None = setting(
        None,
        "Integration step",
        positive("s", None),
        default_text="0.025/k",
    )
    capture: float | None = setting(
        None,
        "Capture distance",
        positive("m", None),
        default_text="0.1 v/k",
    )


@click.command("map")
@takes_settings(NAMED, settings=StartMapSettings)
@figure_option()
@json_option
def map(  # noqa: A001 (the command's name)
    settings: StartMapSettings, figure: Path | None, as_json: bool
) -> None:
    """Simulate games over a grid of initial poses and find the worst one."""
    from ..theory.unicycle.batch import accurate_step
    from ..theory.unicycle.start_maps import (
        StartBox,
        find_worst_start,
        map_starts,
    )

    game = settings.game
    unit = game.evader.speed / game.evader.gain
    gain = min(game.pursuer.gain, game.evader.gain)
    settings = replace(
        settings,
        nearest=settings.nearest or 1.6 * unit,
        farthest=settings.farthest or 4.0 * unit,
        duration=settings.duration or 30.0 / gain,
        step=settings.step or accurate_step(game),
        capture=settings.capture or 0.1 * unit,
    )
    near: Any = settings.nearest
    far: Any = settings.farthest
    box = StartBox(near, far, settings.aim, settings.facing)
    shape = settings.distances, settings.grid, settings.grid
    rules: Any = {
        "step": settings.step,
        "capture_distance": settings.capture,
    }
    duration: Any = settings.duration
    with show_progress("map", prod(shape), "games", quiet=as_json) as bar:
        found = map_starts(
            game, box, duration, shape=shape, progress=bar.update, **rules
        )
    worst = find_worst_start(game, found, box, duration, **rules)
    result = _result(settings, found, worst)
    print_json(result) if as_json else _print(result)
    if figure is not None:
        from ..report.unicycle_figures import draw_map
        from ..theory.unicycle.circles import circles_of

        circles, body = circles_of(game), rules["capture_distance"]
        draw_map(found, str(figure), circles=circles, body=body)


def _result(
    settings: StartMapSettings, found: "StartMap", worst: "WorstStart"
) -> dict[str, Any]:
    """Return all results for JSON."""
    import numpy as np

    from ..theory.unicycle.circles import circles_of
    from ..theory.unicycle.start_maps import settled_fractions

    out, game = found.outcomes, settings.game
    total = len(out.settled_time)
    settled = out.settled_time[np.isfinite(out.settled_time)]
    times = settled if len(settled) else np.array([np.inf])
    circles = circles_of(game)
    shares = settled_fractions(out, len(circles))
    return {
        "games": total,
        "min_distance_m": worst.closest_distance,
        "worst_start": {
            "distance_m": worst.start.distance,
            "pursuer_error_rad": worst.start.pursuer_error,
            "bearing_rad": worst.start.bearing,
            "captured": worst.captured,
        },
        "mean_closest_distance_m": float(out.closest_distance.mean()),
        "captured_share": float(out.captured.mean()),
        "settled_share": len(settled) / total,
        "circles": [
            {
                "circle": CIRCLES[circle.direction],
                "direction": circle.direction,
                "distance_m": circle.distance_m,
                "stable": circle.stable,
                "share": share,
            }
            for circle, share in zip(circles, shares, strict=True)
        ],
        "settled_time_median_s": plain(float(np.median(times))),
        "settled_time_largest_s": plain(float(times.max())),
        "capture_m": settings.capture,
        "duration_s": settings.duration,
        "step_s": settings.step,
        "game": to_entries(game),
    }


def _print(result: dict[str, Any]) -> None:
    """Print the values, the worst start and the circles."""
    shown = {k: v for k, v in result.items() if k != "game"}
    print_table(result_rows(shown))
    if result["circles"]:
        echo()
        print_rows(result["circles"], ("circle", "distance_m", "share"))
