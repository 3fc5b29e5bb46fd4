"""``stepaside circle``: circles of a game, from its equations."""

from typing import Any

import click

from ..core.atomic_output import FIGURES
from ..theory.unicycle.unicycle_game import Game
from .circle_tables import describe_circles, print_circles
from .options.common_options import (
    capture_option,
    delay_option,
    figure_option,
    figure_width,
    json_option,
    sample_time_option,
    seed_option,
)
from .output_files import OutputFile, attempt, writes_files
from .progress import STEPS, announce_effort, show_progress
from .terminal import print_json
from .unicycle_options import describe_game, finite, game_options


@click.command("circle")
@game_options
@sample_time_option()
@delay_option()
@click.option(
    "--sweep",
    type=OutputFile(*FIGURES),
    help="Write a figure of the circle over evasion angle, gain ratio and "
    "speed ratio.",
)
@figure_width
@figure_option(
    help="Write a map of the reversed circle over gain and speed ratio."
)
@click.option(
    "--starts",
    type=click.IntRange(0, 1_000_000),
    default=400,
    show_default=True,
    help="Number of random initial poses simulated to measure the basins of "
    "attraction.",
)
@seed_option(
    default=0, show_default=True, help="Random seed of the initial poses."
)
@capture_option(default=1e-6, show_default=True)
@json_option
@writes_files
def circle(
    game: Game,
    sample_time: float,
    delay: float,
    sweep: str | None,
    figure: str | None,
    starts: int,
    seed: int,
    body: float,
    as_json: bool,
) -> None:
    """Find the circles of a game, their stability and basins of attraction."""
    _announce(game, starts)
    result = describe_circle(game, sample_time, delay)
    drawn = (starts, seed, body)
    with show_progress("circle", starts, "games", quiet=as_json) as bar:
        result |= describe_circles(game, *drawn, bar.update)
    if figure is not None:
        from ..report.unicycle_figures import draw_ratios

        if attempt(lambda: draw_ratios(game, figure)):
            result["figure"] = figure
    if sweep is not None:
        from ..report.unicycle_figures import draw_sweep

        if attempt(lambda: draw_sweep(game, sweep)):
            result["sweep"] = sweep
    if as_json:
        print_json(result)
        return
    print_circles(result)


def _announce(game: Game, starts: int) -> None:
    """Announce long simulations."""
    from ..theory.unicycle.basins import duration_and_step

    duration, step = duration_and_step(game) if starts else (0.0, 1.0)
    announce_effort(f"{starts} games", starts * duration / step / STEPS)


def describe_circle(
    game: Game, sample_time: float = 0.0, delay: float = 0.0
) -> dict[str, Any]:
    """Return the main circle of a game for JSON, None where undefined."""
    from ..theory.unicycle.circles import circle_of

    found = circle_of(game)
    names = (
        "radius_pursuer_m",
        "radius_evader_m",
        "distance_m",
        "turning_rate_rad_s",
        "headings_apart_rad",
        "motions_apart_rad",
        "pursuer_error_rad",
        "evader_error_rad",
        "time_constant_s",
    )
    result: dict[str, Any] = {"exists": found.exists}
    result["radius_m"] = finite(found.radius_pursuer_m)
    result |= {name: finite(getattr(found, name)) for name in names}
    result["eigenvalues_per_s"] = _pairs(found.eigenvalues)
    result["stable"] = found.stable if found.exists else None
    result["sliding"] = found.sliding
    result["sample_time_s"], result["delay_s"] = sample_time, delay
    if found.exists:
        result |= _describe_sampling(game, found.sliding, sample_time, delay)
    result["game"] = describe_game(game)
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
        from math import log

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
    from ..core.errors import PlanError
    from ..theory.unicycle.sampled_stability import largest_stable_delay

    try:
        return finite(largest_stable_delay(game, sample_time))
    except PlanError:
        return None


def _pairs(values: tuple[complex, ...]) -> list[list[float]]:
    return [[value.real, value.imag] for value in values]
