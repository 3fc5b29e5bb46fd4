"""``stepaside map``: closest approach, settling and capture over starts."""

from math import pi, prod
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from ..theory.unicycle.unicycle_game import Game
from .effort_estimate import STEPS, tell_effort
from .options.common_options import (
    CAPTURE,
    FIGURE,
    GAME_TIME,
    figure_width,
    json_option,
)
from .output_files import attempt, writes_files
from .progress import show_progress
from .unicycle_options import describe_game, finite, game_options
from .value_labels import rows_of
from .value_types import ANGLE, METERS, NumberType, print_json, print_table

if TYPE_CHECKING:
    from ..theory.unicycle.start_maps import StartBox, StartMap, WorstStart

TIME = NumberType("s")


@click.command("map")
@game_options
@click.option(
    "--nearest", type=METERS, help="Least distance [m]. [default: 1.6 v/k]"
)
@click.option(
    "--farthest", type=METERS, help="Largest distance [m]. [default: 4 v/k]"
)
@click.option(
    "--aim",
    type=ANGLE,
    default=pi,
    help="Largest bearing [rad] of the evader seen by the pursuer. "
    "[default: pi]",
)
@click.option(
    "--facing",
    type=ANGLE,
    default=pi,
    help="Largest bearing [rad] of the pursuer seen by the evader. "
    "[default: pi]",
)
@CAPTURE.option(
    help="Distance {unit} that counts as capture. [default: 0.1 v/k]"
)
@click.option(
    "--grid",
    type=click.IntRange(2, 400),
    default=25,
    show_default=True,
    help="Points along each bearing.",
)
@click.option(
    "--distances",
    type=click.IntRange(1, 400),
    default=6,
    show_default=True,
    help="Points along the distance.",
)
@GAME_TIME.option(help="Length {unit} of each game. [default: 30/k]")
@click.option(
    "--step", type=TIME, help="Of the integration, in [s]. [default: .01/k]"
)
@FIGURE.option()
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
    """Play games from everywhere and find the worst start."""
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
    rules = _Rules(
        (distances, grid, grid),
        30.0 / gain if duration is None else duration,
        0.01 / gain if step is None else step,
        0.1 * unit if body is None else body,
    )
    found = _play(game, box, rules, quiet=as_json)
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
        from ..report.unicycle_map import draw_map
        from ..theory.unicycle.all_circles import circles_of

        circles = circles_of(game)
        if attempt(
            lambda: draw_map(found, figure, circles=circles, body=rules.body)
        ):
            result["figure"] = figure
    if as_json:
        print_json(result)
    else:
        _print(result)


class _Rules(NamedTuple):
    """Of a map: starts along each side, durations in [s], body in [m]."""

    shape: tuple[int, int, int]
    duration: float
    step: float
    body: float


def _play(
    game: Game, box: "StartBox", rules: _Rules, *, quiet: bool
) -> "StartMap":
    """Play from everywhere, and say how long that takes."""
    from ..theory.unicycle.start_maps import map_starts

    total = prod(rules.shape)
    steps = rules.duration / rules.step
    tell_effort(f"{total} games of {steps:.0f} steps", total * steps / STEPS)
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
    rules: _Rules,
    found: "StartMap",
    worst: "WorstStart",
) -> dict[str, Any]:
    """Everything that is printed, by name."""
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
    """One row for each number, circle and part of the worst start."""
    names = (n for n, v in result.items() if not isinstance(v, dict | list))
    rows = rows_of(result, names)
    for circle in result["circles"]:
        way = "main" if circle["direction"] > 0 else "reversed"
        apart, share = circle["distance_m"], 100.0 * circle["share"]
        text = f"{share:.6g} % at {apart:.6g} m"
        rows.append((f"on the {way} circle", text))
    start = result["worst_start"]
    worst = rows_of(start, start)
    print_table([*rows, *((f"worst start: {k}", v) for k, v in worst)])


def _circles(game: Game, outcomes: Any) -> list[dict[str, Any]]:
    """Every circle of the game, with the share of games that are on it."""
    from ..theory.unicycle.all_circles import circles_of
    from ..theory.unicycle.basins import shares_of

    circles = circles_of(game)
    return [
        {
            "direction": circle.direction,
            "distance_m": circle.distance_m,
            "stable": circle.stable,
            "share": share,
        }
        for circle, share in zip(
            circles, shares_of(outcomes, len(circles)), strict=True
        )
    ]
