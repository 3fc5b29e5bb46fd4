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
from .options import figure_option, json_option
from .settings import takes_settings
from .tables import plain, print_rows, print_table, result_rows
from .terminal import echo, print_json

NAMED = ("speed", "gain", "angle", "law", "starts")
COLUMNS = (
    *("circle", "side_rule", "distance_m", "radius_evader_m", "stable"),
    *("time_constant_s", "share"),
)


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
@figure_option(help="Write a figure of the circle over angle and ratios.")
@json_option
def circle(
    settings: CircleSettings, figure: Path | None, as_json: bool
) -> None:
    """Find the circles of a game, their stability and basins of attraction."""
    game = settings.game
    result = describe_circle(game, settings.sample_time, settings.delay)
    with show_progress("circle", settings.starts, "games", quiet=as_json) as b:
        result |= _find_circles(settings, b.update)
    print_json(result) if as_json else print_circles(result)
    if figure is not None:
        from ..report.unicycle_figures import draw_sweep

        draw_sweep(game, str(figure))


def _entries_of(found: Any) -> dict[str, Any]:
    """Return one circle for JSON."""
    entries: dict[str, Any] = plain(found)
    entries["eigenvalues_per_s"] = entries.pop("eigenvalues")
    return entries


def describe_circle(
    game: Game, sample_time: float = 0.0, delay: float = 0.0
) -> dict[str, Any]:
    """Return the main circle of a game for JSON, None where undefined."""
    from ..theory.unicycle.circles import circle_of

    found = circle_of(game)
    result = _entries_of(found) | {
        "radius_m": plain(found.radius_pursuer_m),
        "sample_time_s": sample_time,
        "delay_s": delay,
    }
    if found.exists:
        result |= _describe_sampling(game, found.sliding, sample_time, delay)
    return result | {"game": to_entries(game)}


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
        "largest_stable_sample_time_s": plain(
            sampled.largest_stable_sample_time(game, delay)
        ),
    }
    try:
        largest = sampled.largest_stable_delay(game, sample_time)
        result["largest_stable_delay_s"] = plain(largest)
    except PlanError:  # sampling is too fine
        result["largest_stable_delay_s"] = None
    if sample_time > 0.0:
        values = sampled.step_eigenvalues(game, sample_time, delay)
        size = abs(values[0])
        result["step_eigenvalues"] = plain(values)
        result["stable"] = size < 1.0
        settle = -sample_time / log(size) if 0.0 < size < 1.0 else None
        result["time_constant_s"] = settle
    elif delay > 0.0:
        values = sampled.delayed_eigenvalues(game, delay)
        rate = values[0].real
        result["delayed_eigenvalues_per_s"] = plain(values)
        result["stable"] = rate < 0.0
        result["time_constant_s"] = -1.0 / rate if rate < 0.0 else None
    return result


def _find_circles(settings: CircleSettings, progress: Any) -> dict[str, Any]:
    """Return every circle, and the fraction of starts that end on it."""
    from ..theory.unicycle.circles import circles_of
    from ..theory.unicycle.start_maps import find_basins, random_starts

    game = settings.game
    circles = circles_of(game)
    shares: tuple[float | None, ...] = (None,) * len(circles)
    starts = None
    if settings.starts:
        drawn = random_starts(game, settings.starts, seed=settings.seed)
        basins = find_basins(
            game, drawn, capture_distance=settings.capture, progress=progress
        )
        shares = basins.shares
        starts = {
            "number": settings.starts,
            "captured_share": basins.captured,
            "unsettled_share": basins.unsettled,
            "mean_closest_distance_m": basins.closest_distance,
        }
    return {
        "circles": [
            {
                "circle": CIRCLES[each.direction],
                "direction": each.direction,
                "side_rule": "behind" if each.behind else "latched",
                **_entries_of(each),
                "share": share,
            }
            for each, share in zip(circles, shares, strict=True)
        ],
        "starts": starts,
    }


def print_circles(result: dict[str, Any]) -> None:
    """Print the main circle, then all circles as a table."""
    if result["exists"]:
        aside = ("circles", "game", "starts", "step_eigenvalues")
        shown = {k: v for k, v in result.items() if k not in aside}
        print_table(result_rows(shown, 6))
    else:
        which = "main circle" if result["circles"] else "circle"
        echo(f"There is no {which} for these speeds, gains and angle.")
    if result["circles"]:
        echo()
        print_rows(result["circles"], COLUMNS, left=range(7), digits=6)
    if result["starts"] is not None:
        echo("\n  games from random starts")
        print_table(result_rows(result["starts"]))
