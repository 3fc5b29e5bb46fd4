"""``stepaside map``: outcomes of games over their initial poses."""

from math import pi, prod
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from ..theory.unicycle.unicycle_game import Game
from .options.common_options import (
    capture_option,
    figure_option,
    figure_width,
    game_time_option,
    json_option,
)
from .options.parameter_types import ANGLE, METERS, NumberType
from .output_files import attempt, writes_files
from .progress import STEPS, announce_effort, show_progress
from .tables import print_table, scalar_rows, table_rows
from .terminal import print_json
from .unicycle_options import describe_game, finite, game_options

if TYPE_CHECKING:
    from ..theory.unicycle.start_maps import StartBox, StartMap, WorstStart

TIME = NumberType("s")


@click.command("map")
@game_options
@click.option(
    "--nearest",
    type=METERS,
    help="Minimum initial distance [m].  [default: 1.6 v/k]",
)
@click.option(
    "--farthest",
    type=METERS,
    help="Maximum initial distance [m].  [default: 4 v/k]",
)
@click.option(
    "--aim",
    type=ANGLE,
    default=pi,
    help="Maximum initial bearing of the evader in the pursuer's frame "
    "[rad].  [default: pi]",
)
@click.option(
    "--facing",
    type=ANGLE,
    default=pi,
    help="Maximum initial bearing of the pursuer in the evader's frame "
    "[rad].  [default: pi]",
)
@capture_option(help="Capture distance [m].  [default: 0.1 v/k]")
@click.option(
    "--grid",
    type=click.IntRange(2, 400),
    default=25,
    show_default=True,
    help="Grid points along each bearing.",
)
@click.option(
    "--distances",
    type=click.IntRange(1, 400),
    default=6,
    show_default=True,
    help="Grid points along the distance.",
)
@game_time_option(help="Duration of each game [s].  [default: 30/k]")
@click.option(
    "--step", type=TIME, help="Integration step [s].  [default: 0.025/k]"
)
@figure_option()
@figure_width
@json_option
@writes_files
def map(  # noqa: A001 (the command's name)
    game: Game,
    nearest: float | None,
    farthest: float | None,
    aim: float,
    facing: float,
    body: float | None,
    grid: int,
    distances: int,
    duration: float | None,
    step: float | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Simulate games over a grid of initial poses and find the worst one."""
    from ..theory.unicycle.batch import accurate_step
    from ..theory.unicycle.start_maps import StartBox, find_worst_start

    for name, value in (("--aim", aim), ("--facing", facing)):
        if not 0.0 <= value <= pi:
            raise click.BadParameter(
                f"must lie in [0, pi] [rad], got {value}", param_hint=name
            )
    unit = game.evader.speed / game.evader.gain
    gain = min(game.pursuer.gain, game.evader.gain)
    box = StartBox(
        1.6 * unit if nearest is None else nearest,
        4.0 * unit if farthest is None else farthest,
        aim,
        facing,
    )
    rules = _MapSettings(
        (distances, grid, grid),
        30.0 / gain if duration is None else duration,
        accurate_step(game) if step is None else step,
        0.1 * unit if body is None else body,
    )
    found = _simulate(game, box, rules, quiet=as_json)
    worst = find_worst_start(
        game,
        found,
        box,
        rules.duration,
        step=rules.step,
        capture_distance=rules.body,
    )
    result = _result(game, box, rules, found, worst)
    if figure is not None:
        from ..report.unicycle_figures import draw_map
        from ..theory.unicycle.circles import circles_of

        circles = circles_of(game)
        if attempt(
            lambda: draw_map(found, figure, circles=circles, body=rules.body)
        ):
            result["figure"] = figure
    if as_json:
        print_json(result)
    else:
        _print(result)


class _MapSettings(NamedTuple):
    """Grid points per axis, duration and step in [s], capture in [m]."""

    shape: tuple[int, int, int]
    duration: float
    step: float
    body: float


def _simulate(
    game: Game, box: "StartBox", rules: _MapSettings, *, quiet: bool
) -> "StartMap":
    """Simulate all games with a progress bar."""
    from ..theory.unicycle.start_maps import map_starts

    total = prod(rules.shape)
    steps = rules.duration / rules.step
    announce_effort(
        f"{total} games of {steps:.0f} steps", total * steps / STEPS
    )
    with show_progress("map", total, "games", quiet=quiet) as bar:
        return map_starts(
            game,
            box,
            rules.duration,
            shape=rules.shape,
            step=rules.step,
            capture_distance=rules.body,
            progress=bar.update,
        )


def _result(
    game: Game,
    box: "StartBox",
    rules: _MapSettings,
    found: "StartMap",
    worst: "WorstStart",
) -> dict[str, Any]:
    """Return all results for JSON."""
    import numpy as np

    out, total = found.outcomes, prod(rules.shape)
    settled = out.settled_time[np.isfinite(out.settled_time)]
    times = settled if len(settled) else np.array([np.inf])
    return {
        "games": total,
        "games_to_refine": worst.games - total,
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
        "circles": _circles(game, out),
        "settled_time_median_s": finite(float(np.median(times))),
        "settled_time_largest_s": finite(float(times.max())),
        "body_m": rules.body,
        "duration_s": rules.duration,
        "step_s": rules.step,
        "box": {
            "nearest_m": box.nearest,
            "farthest_m": box.farthest,
            "aim_rad": box.aim,
            "facing_rad": box.facing,
        },
        "game": describe_game(game),
    }


def _print(result: dict[str, Any]) -> None:
    """Print the values, the circles and the worst start."""
    rows = scalar_rows(result)
    for circle in result["circles"]:
        direction = "main" if circle["direction"] > 0 else "reversed"
        percent = 100.0 * circle["share"]
        text = f"{percent:.6g} % at {circle['distance_m']:.6g} m"
        rows.append((f"on the {direction} circle", text))
    start = result["worst_start"]
    worst = table_rows(start, start)
    print_table([*rows, *((f"worst start: {k}", v) for k, v in worst)])


def _circles(game: Game, outcomes: Any) -> list[dict[str, Any]]:
    """Return every circle with the fraction of games that end on it."""
    from ..theory.unicycle.basins import settled_fractions
    from ..theory.unicycle.circles import circles_of

    circles = circles_of(game)
    return [
        {
            "direction": circle.direction,
            "distance_m": circle.distance_m,
            "stable": circle.stable,
            "share": share,
        }
        for circle, share in zip(
            circles, settled_fractions(outcomes, len(circles)), strict=True
        )
    ]
