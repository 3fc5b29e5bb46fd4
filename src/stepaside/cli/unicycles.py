"""``stepaside unicycles``: one game as a table, a figure or JSON."""

from dataclasses import asdict
from typing import Any

import click

from ..core.setting import settings_of
from ..games.duel_settings import DuelSettings
from ..theory.unicycle.unicycle_game import Game
from .circle import describe_circle
from .options.common_options import (
    delay_option,
    figure_option,
    figure_width,
    game_time_option,
    json_option,
    sample_time_option,
)
from .options.parameter_types import ANGLE, METERS, StrategyType
from .output_files import attempt, writes_files
from .progress import (
    DECISIONS,
    SAMPLES,
    TIME_CONSTANTS,
    announce_effort,
)
from .tables import format_value, label_of, print_table, table_rows
from .terminal import print_json
from .unicycle_options import describe_game, finite, game_options
from .unicycle_strategies import check_used, play_named_game, print_named_game

DUEL = settings_of(DuelSettings)
SHORT = 0.01  # decision period without sampling, in [s]


@click.command("unicycles")
@game_options
@click.option(
    "--distance",
    type=METERS,
    help="Initial distance [m].  [default: 2.5 v/k]",
)
@click.option(
    "--aim",
    type=ANGLE,
    default=0.2,
    show_default=True,
    help="Initial bearing of the evader in the pursuer's frame [rad].",
)
@click.option(
    "--bearing",
    type=ANGLE,
    default=-0.1,
    show_default=True,
    help="Initial bearing of the pursuer in the evader's frame [rad].",
)
@game_time_option(
    help="Duration of the game [s].  [default: until it has settled]"
)
@sample_time_option()
@delay_option()
@click.option(
    "--capture-distance",
    type=METERS,
    default=1e-6,
    show_default=True,
    help="Capture distance [m]; ends the game.",
)
@click.option(
    "--evader-strategy",
    type=StrategyType(),
    help=f"{DUEL['evader_strategy'].text}  [default: evasion]",
)
@click.option(
    "--pursuer-strategy",
    type=StrategyType(),
    help=f"{DUEL['pursuer_strategy'].text}  [default: pursuit]",
)
@figure_option()
@figure_width
@json_option
@writes_files
def unicycles(
    game: Game,
    distance: float | None,
    aim: float,
    bearing: float,
    duration: float | None,
    sample_time: float,
    delay: float,
    capture_distance: float,
    evader_strategy: str | None,
    pursuer_strategy: str | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Simulate one game of two unicycles and compare it with theory."""
    from ..theory.unicycle.circle_fit import settling_time
    from ..theory.unicycle.relative_coordinates import RelativeStart

    if distance is None:
        distance = 2.5 * game.evader.speed / game.evader.gain
    if duration is None:
        duration = settling_time(game)
    if delay > 0.0 and sample_time == 0.0:
        raise click.UsageError("--delay requires --sample-time > 0 [s]")
    named = bool(evader_strategy or pursuer_strategy)
    _announce(game, duration, sample_time, named=named)
    start = RelativeStart(distance, aim, bearing)
    result: dict[str, Any] = {
        "start": asdict(start),
        "capture_distance_m": capture_distance,
        "sample_time_s": sample_time,
        "delay_s": delay,
        "game": describe_game(game),
    }
    if named:
        if figure is not None or delay > 0.0:
            raise click.UsageError(
                "--figure and --delay cannot be combined with "
                "--evader-strategy or --pursuer-strategy"
            )
        names = (pursuer_strategy or "pursuit", evader_strategy or "evasion")
        check_used(names)
        result |= play_named_game(
            game,
            start,
            names,
            (duration, sample_time or SHORT),
            capture_distance,
        )
        print_json(result) if as_json else print_named_game(result)
        return
    if sample_time > 0.0:
        if figure is not None:
            raise click.UsageError(
                "--figure cannot be combined with --sample-time"
            )
        times = (duration, sample_time, delay)
        result |= _simulate_sampled(game, start, times, capture_distance)
    else:
        result |= _simulate(game, start, duration, capture_distance, figure)
    theory = describe_circle(game)
    result["theory"] = {
        name: theory[name] for name in ("exists", *_NAMES, "time_constant_s")
    }
    result["certified"] = _certify(game, start)
    if as_json:
        print_json(result)
    else:
        _print(result)


_NAMES = (
    "radius_m",
    "radius_pursuer_m",
    "radius_evader_m",
    "distance_m",
    "turning_rate_rad_s",
    "headings_apart_rad",
    "motions_apart_rad",
)


def _announce(
    game: Game, duration: float, sample_time: float, *, named: bool
) -> None:
    """Announce a long simulation."""
    gain = max(game.pursuer.gain, game.evader.gain)
    seconds = duration * gain / TIME_CONSTANTS
    if named:
        seconds = duration / (sample_time or SHORT) / DECISIONS
    elif sample_time > 0.0:
        seconds = duration / sample_time / SAMPLES
    announce_effort(f"a game of {duration:g} s", seconds)


def _simulate(
    game: Game, start: Any, duration: float, capture: float, figure: str | None
) -> dict[str, Any]:
    """Simulate with the adaptive integrator and measure the paths."""
    from ..theory.unicycle.adaptive_simulation import simulate
    from ..theory.unicycle.circle_fit import measure

    run = simulate(game, start, duration, capture_distance=capture)
    result: dict[str, Any] = {
        "captured": run.captured,
        "end_time_s": run.end_time,
        "closest_distance_m": run.closest_distance,
        "closest_time_s": run.closest_time,
        "switch_times_s": list(run.switches),
    }
    if not run.captured:
        found = {k: finite(v) for k, v in asdict(measure(run)).items()}
        result |= {"radius_m": found["radius_pursuer_m"]} | found
        result["turning_rate_rad_s"] = abs(found["turning_rate_rad_s"] or 0.0)
        last = run.states([run.end_time])[0, :3]
        result["circle"] = _ended_on(game, last, run.sides[-1])
    if figure is not None:
        from ..report.unicycle_figures import draw_game

        if attempt(lambda: draw_game(run, figure)):
            result["figure"] = figure
    return result


def _certify(game: Game, start: Any) -> dict[str, Any] | None:
    """Return the certified closest approach; None where it is undefined."""
    from ..core.errors import PlanError
    from ..theory.unicycle.certificate import certify

    try:
        found = certify(game, start)
    except PlanError:  # unequal players, the saturated law or moving back
        return None
    return {"holds": found.holds, "distance_m": found.distance_m}


def _ended_on(game: Game, state: Any, side: int) -> dict[str, Any] | None:
    """Return the circle of the final state; None if it is on none."""
    from ..theory.unicycle.circle_fit import circle_at
    from ..theory.unicycle.circles import circles_of

    circle = circle_at(circles_of(game), state, side)
    if circle is None:
        return None
    return {
        "direction": circle.direction,
        "distance_m": circle.distance_m,
        "stable": circle.stable,
    }


def _simulate_sampled(
    game: Game, start: Any, times: tuple[float, float, float], capture: float
) -> dict[str, Any]:
    """Simulate with sampled turning rates; measure the final circle."""
    from math import pi

    from ..core.poses import wrap_angle
    from ..theory.unicycle.sampled_game import simulate_sampled

    duration, period, delay = times
    run = simulate_sampled(
        game,
        start,
        duration,
        period,
        delay=delay,
        capture_distance=capture,
    )
    result: dict[str, Any] = {
        "captured": run.captured,
        "end_time_s": float(run.times[-1]),
        "closest_distance_m": run.closest_distance,
    }
    if run.captured or not len(run.turning_rates):
        return result
    turn_p, turn_e = abs(run.turning_rates[-1]).tolist()
    heading = float(run.pursuer[-1, 2] - run.evader[-1, 2])
    return result | {
        "radius_m": finite(game.pursuer.speed / max(turn_p, 1e-300)),
        "radius_pursuer_m": finite(game.pursuer.speed / max(turn_p, 1e-300)),
        "radius_evader_m": finite(game.evader.speed / max(turn_e, 1e-300)),
        "distance_m": float(run.states[-1, 0]),
        "turning_rate_rad_s": turn_p,
        "headings_apart_rad": abs(wrap_angle(heading)),
        "motions_apart_rad": abs(wrap_angle(heading + pi)),
    }


def _print(result: dict[str, Any]) -> None:
    """Print measured values beside the closed form."""
    theory = result["theory"]
    rows = [("", "simulated        closed form")]
    for name in _NAMES[1:]:
        cells = [result.get(name), theory[name]]
        texts = [format_value(name, cell) for cell in cells]
        rows.append((label_of(name), f"{texts[0]:<16} {texts[1]}"))
    circle = result.get("circle")
    if circle is not None:
        direction = "main" if circle["direction"] > 0 else "reversed"
        rows.append(("ended on", f"the {direction} circle"))
    certified = result["certified"]
    if certified is not None and certified["holds"]:
        text = f">= {certified['distance_m']:.6g} m"
        rows.append(("certified distance", text))
    ends = ("captured", "end_time_s", "closest_distance_m")
    rows += table_rows(result, ends)
    if "figure" in result:
        rows.append(("figure", result["figure"]))
    print_table(rows)
