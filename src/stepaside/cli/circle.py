"""``stepaside theory circle``: circles of a game, from its equations."""

from dataclasses import dataclass
from math import log
from pathlib import Path
from typing import Any

import click

from ..core.entries import to_entries
from ..core.errors import PlanError
from ..core.progress import show_progress
from ..core.ranges import SEEDS, Range
from ..core.setting import setting
from ..games.unicycle_settings import UnicycleGameSettings, positive
from ..report.result_labels import CIRCLES
from ..theory.unicycle.unicycle_game import Game
from .options import figure_option, figure_width, json_option
from .settings import takes_settings
from .tables import (
    finite,
    format_value,
    print_columns,
    print_table,
    table_rows,
)
from .terminal import echo, print_json

NAMED = ("speed", "gain", "angle", "law", "starts")
OF_CIRCLE = (
    "distance_m",
    "radius_pursuer_m",
    "radius_evader_m",
    "turning_rate_rad_s",
    "headings_apart_rad",
    "motions_apart_rad",
    "pursuer_error_rad",
    "evader_error_rad",
    "time_constant_s",
)
COLUMNS = {
    "direction": "direction",
    "side_rule": "side rule",
    "distance_m": "distance",
    "radius_evader_m": "evader's radius",
    "stable": "stable",
    "time_constant_s": "time constant",
    "starts_share": "basin",
}


@dataclass(frozen=True, slots=True)
class CircleSettings(UnicycleGameSettings):
    """Game, sampling, and random starts of the basins of attraction."""

    sample_time: float = setting(
        0.0,
        "Sampling period; turning rates are constant in between",
        positive("s", 0.0),
    )
    delay: float = setting(
        0.0, "Delay from sensing to turning", positive("s", 0.0)
    )
    starts: int = setting(
        400,
        "Number of random starts, for the basins of attraction",
        Range(0, 1_000_000, "1", "more take hours", whole=True),
    )
    seed: int = setting(0, "Random seed of the starts", SEEDS)
    capture: float = setting(1e-6, "Capture distance", positive("m"))


@click.command("circle")
@takes_settings(NAMED, settings=CircleSettings)
@figure_option(help="Write a map of the reversed circle over the ratios.")
@figure_option(
    "--sweep", help="Write a figure of the circle over angle and ratios."
)
@figure_width
@json_option
def circle(
    settings: CircleSettings,
    figure: Path | None,
    sweep: Path | None,
    as_json: bool,
) -> None:
    """Find the circles of a game, their stability and basins of attraction."""
    game = settings.game
    result = describe_circle(game, settings.sample_time, settings.delay)
    with show_progress("circle", settings.starts, "games", quiet=as_json) as b:
        result |= _find_circles(settings, b.update)
    print_json(result) if as_json else print_circles(result)
    if figure is not None:
        from ..report.unicycle_figures import draw_ratios

        draw_ratios(game, str(figure))
    if sweep is not None:
        from ..report.unicycle_figures import draw_sweep

        draw_sweep(game, str(sweep))


def describe_circle(
    game: Game, sample_time: float = 0.0, delay: float = 0.0
) -> dict[str, Any]:
    """Return the main circle of a game for JSON, None where undefined."""
    from ..theory.unicycle.circles import circle_of

    found = circle_of(game)
    result: dict[str, Any] = {
        "exists": found.exists,
        "radius_m": finite(found.radius_pursuer_m),
        **{name: finite(getattr(found, name)) for name in OF_CIRCLE},
        "eigenvalues_per_s": _pairs(found.eigenvalues),
        "stable": found.stable if found.exists else None,
        "sliding": found.sliding,
        "sample_time_s": sample_time,
        "delay_s": delay,
    }
    if found.exists:
        result |= _describe_sampling(game, found.sliding, sample_time, delay)
    result["game"] = to_entries(game)
    return result


def _describe_sampling(
    game: Game, sliding: bool, sample_time: float, delay: float
) -> dict[str, Any]:
    """Return the stability under sampling and delay; empty if undefined.

    The entry ``eigenvalues_per_s`` remains that without sampling.
    """
    from ..theory.unicycle import sampled_stability as sampled

    if sliding:  # chattering: no linearisation exists
        sampled_or_delayed = sample_time > 0.0 or delay > 0.0
        undefined = {"stable": None, "time_constant_s": None}
        return undefined if sampled_or_delayed else {}
    result: dict[str, Any] = {
        "largest_stable_sample_time_s": finite(
            sampled.largest_stable_sample_time(game, delay)
        ),
        "largest_stable_delay_s": _largest_delay(game, sample_time),
    }
    if sample_time > 0.0:
        values = sampled.step_eigenvalues(game, sample_time, delay)
        size = abs(values[0])
        result["step_eigenvalues"] = _pairs(values)
        result["stable"] = size < 1.0
        settle = -sample_time / log(size) if 0.0 < size < 1.0 else None
        result["time_constant_s"] = settle
    elif delay > 0.0:
        values = sampled.delayed_eigenvalues(game, delay)
        rate = values[0].real
        result["delayed_eigenvalues_per_s"] = _pairs(values)
        result["stable"] = rate < 0.0
        result["time_constant_s"] = -1.0 / rate if rate < 0.0 else None
    return result


def _largest_delay(game: Game, sample_time: float) -> float | None:
    """Return the largest stable delay; None if sampling is too fine."""
    from ..theory.unicycle.sampled_stability import largest_stable_delay

    try:
        return finite(largest_stable_delay(game, sample_time))
    except PlanError:
        return None


def _pairs(values: tuple[complex, ...]) -> list[list[float]]:
    return [[value.real, value.imag] for value in values]


def _find_circles(settings: CircleSettings, progress: Any) -> dict[str, Any]:
    """Return every circle, and the fraction of starts that end on it."""
    from ..theory.unicycle.circles import circles_of
    from ..theory.unicycle.start_maps import find_basins, random_starts

    game = settings.game
    if settings.starts == 0:
        found = [_describe(each, None) for each in circles_of(game)]
        return {"circles": found, "starts": None}
    drawn = random_starts(game, settings.starts, seed=settings.seed)
    basins = find_basins(
        game, drawn, capture_distance=settings.capture, progress=progress
    )
    return {
        "circles": [
            _describe(each, share)
            for each, share in zip(basins.circles, basins.shares, strict=True)
        ],
        "starts": {
            "number": settings.starts,
            "seed": settings.seed,
            "nearest_m": float(drawn[:, 0].min()),
            "farthest_m": float(drawn[:, 0].max()),
            "duration_s": basins.duration,
            "capture_m": settings.capture,
            "captured_share": basins.captured,
            "unsettled_share": basins.unsettled,
            "mean_closest_distance_m": basins.closest_distance,
        },
    }


def _describe(found: Any, share: float | None) -> dict[str, Any]:
    """Return one circle for JSON."""
    return {
        "exists": found.exists,
        "direction": found.direction,
        "side_rule": "behind" if found.behind else "latched",
        **{name: finite(getattr(found, name)) for name in OF_CIRCLE},
        "bearing_rad": found.bearing_rad,
        "sliding": found.sliding,
        "stable": found.stable,
        "eigenvalues_per_s": _pairs(found.eigenvalues),
        "share": share,
    }


def print_circles(result: dict[str, Any]) -> None:
    """Print the result as tables."""
    lists = ("circles", "game", "starts")
    if result["exists"]:
        print_table(table_rows(result, (k for k in result if k not in lists)))
    else:
        which = "main circle" if result["circles"] else "circle"
        echo(f"There is no {which} for these speeds, gains and angle.")
    rows = [
        each
        | {
            "direction": CIRCLES[each["direction"]],
            "starts_share": each["share"],
        }
        for each in result["circles"]
    ]
    if rows:
        echo()
        print_columns(
            list(COLUMNS.values()),
            [
                [format_value(name, row[name]) for name in COLUMNS]
                for row in rows
            ],
            left=range(len(COLUMNS)),
            indent="  ",
        )
    if result["starts"] is not None:
        echo("\n  games that did not end on a circle")
        names = ("captured_share", "unsettled_share")
        print_table(table_rows(result["starts"], names))
