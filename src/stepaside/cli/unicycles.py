"""``stepaside run unicycles``: one game as a table, a figure or JSON."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.entries import to_entries
from ..core.errors import PlanError
from ..games.unicycle_settings import PAPER, UnicycleSettings
from ..report.result_labels import CIRCLES, label_of
from .circle import describe_circle
from .options import figure_option, json_option
from .settings import refuse_settings, takes_settings
from .tables import (
    format_value,
    plain,
    print_table,
    result_rows,
    table_rows,
)
from .terminal import print_json

if TYPE_CHECKING:
    from ..theory.unicycle.unicycle_game import Game, RelativeStart

NAMED = (
    *("speed", "gain", "angle", "law", "distance"),
    *("aim", "bearing", "duration", "evader_strategy"),
)
COMPARED = (
    "radius_pursuer_m",
    "radius_evader_m",
    "distance_m",
    "turning_rate_rad_s",
    "headings_apart_rad",
    "motions_apart_rad",
)


@click.command("unicycles")
@takes_settings(NAMED, settings=UnicycleSettings)
@figure_option()
@json_option
def unicycles(
    settings: UnicycleSettings, figure: Path | None, as_json: bool
) -> None:
    """Simulate one game of two unicycles and compare it with theory."""
    game, start, names = settings.game, settings.start, settings.strategies
    result: dict[str, Any] = {
        "start": asdict(start),
        "capture_distance_m": settings.capture,
        "sample_time_s": settings.sample_time,
        "game": to_entries(game),
    }
    if figure is not None and names is not None:
        raise click.UsageError(
            "--figure requires the strategies of the paper, without "
            "sample_time"
        )
    run: Any = None
    if names is None:
        run, measured = _simulate(settings, start)
        result |= measured | {"certified": _certify(game, start)}
    else:
        result |= _play_named(settings, names)
    if names is None or names == PAPER:
        theory = describe_circle(game)
        named = ("exists", "radius_m", *COMPARED, "time_constant_s")
        result["theory"] = {name: theory[name] for name in named}
    if as_json:
        print_json(result)
    elif "theory" in result:
        _print(result)
    else:
        aside = ("game", "start")
        shown = {k: v for k, v in result.items() if k not in aside}
        print_table(result_rows(shown))
    if figure is not None:
        from ..report.unicycle_figures import draw_game

        draw_game(run, str(figure))


def _simulate(
    settings: UnicycleSettings, start: "RelativeStart"
) -> tuple[Any, dict[str, Any]]:
    """Simulate with the adaptive integrator and measure the paths."""
    from ..theory.unicycle.adaptive_simulation import simulate
    from ..theory.unicycle.circle_fit import circle_at, measure
    from ..theory.unicycle.circles import circles_of

    run = simulate(
        settings.game,
        start,
        settings.time,
        capture_distance=settings.capture,
    )
    result: dict[str, Any] = {
        "captured": run.captured,
        "end_time_s": run.end_time,
        "closest_distance_m": run.closest_distance,
        "closest_time_s": run.closest_time,
        "switch_times_s": list(run.switches),
    }
    if not run.captured:
        found = plain(measure(run))
        result |= {"radius_m": found["radius_pursuer_m"]} | found
        result["turning_rate_rad_s"] = abs(found["turning_rate_rad_s"] or 0.0)
        last = run.states([run.end_time])[0, :3]
        ended = circle_at(circles_of(settings.game), last, run.sides[-1])
        result["circle"] = ended and {
            "direction": ended.direction,
            "distance_m": ended.distance_m,
            "stable": ended.stable,
        }
    return run, result


def _certify(game: "Game", start: "RelativeStart") -> dict[str, Any] | None:
    """Return the certified closest approach; None where it is undefined."""
    from ..theory.unicycle.certificate import certify

    try:
        found = certify(game, start)
    except PlanError:  # unequal players, the saturated law or moving back
        return None
    entries: dict[str, Any] = plain(found)
    return entries


def _play_named(
    settings: UnicycleSettings, names: tuple[str, str]
) -> dict[str, Any]:
    """Simulate a game of any two strategies."""
    import numpy as np

    from ..core.poses import wrap_angle
    from ..games.floor_games import play_unicycles
    from ..strategies.registry import OF_EVASION
    from ..theory.unicycle.circle_fit import fit_circle

    if not set(names) & set(OF_EVASION):
        refuse_settings(
            ("angle", "law", "side_rule", "hysteresis"),
            f"the strategy {' or '.join(OF_EVASION)}, got {names[1]}",
        )
    times, capture = (settings.time, settings.period), settings.capture
    run = play_unicycles(settings.game, settings.start, names, times, capture)
    paths = run.pursuer, run.evader
    floor = [float(np.hypot(*(p - p[0])[:, :2].T).max()) for p in paths]
    radii = [fit_circle(p[-len(p) // 5 :, :2])[1] for p in paths]
    heading = float(run.pursuer[-1, 2] - run.evader[-1, 2])
    return {
        "pursuer_strategy": names[0],
        "evader_strategy": names[1],
        "captured": run.captured,
        "end_time_s": float(run.times[-1]),
        "closest_distance_m": run.closest_distance,
        "distance_m": float(run.distances[-1]),
        "radius_m": radii[0],
        "radius_pursuer_m": radii[0],
        "radius_evader_m": radii[1],
        "headings_apart_rad": abs(wrap_angle(heading)),
        "motions_apart_rad": abs(wrap_angle(heading + np.pi)),
        "floor_used_pursuer_m": floor[0],
        "floor_used_evader_m": floor[1],
    }


def _print(result: dict[str, Any]) -> None:
    """Print measured values beside the closed form."""
    theory = result["theory"]
    rows = [("", "simulated        closed form")]
    for name in COMPARED:
        cells = [result.get(name), theory[name]]
        texts = [format_value(name, cell) for cell in cells]
        rows.append((label_of(name), f"{texts[0]:<16} {texts[1]}"))
    circle = result.get("circle")
    if circle is not None:
        name = CIRCLES[circle["direction"]]
        rows.append(("ended on", f"the {name} circle"))
    certified = result.get("certified")
    if certified is not None and certified["holds"]:
        text = f">= {certified['distance_m']:.6g} m"
        rows.append(("certified distance", text))
    ends = ("captured", "end_time_s", "closest_distance_m")
    print_table([*rows, *table_rows(result, ends)])
