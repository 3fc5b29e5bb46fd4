"""``stepaside theory``: circles, maps, bounds and plans."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import degrees, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.entries import to_entries
from ..core.errors import PlanError
from ..core.progress import ProgressLine
from ..core.ranges import SEEDS, Range, positive
from ..core.setting import CheckedSettings, setting
from ..planning import PRESETS, Direction, Foot, GaitSettings
from ..report.result_labels import CIRCLES
from ..theory.unicycle.unicycle_settings import UnicycleGameSettings
from .main import LazyGroup
from .options import figure_option
from .settings import takes_settings
from .tables import (
    plain,
    print_columns,
    print_rows,
    print_table,
    result_rows,
)
from .terminal import echo, json_option, print_json

if TYPE_CHECKING:
    from ..planning import ManeuverPlan

COMMANDS = {
    "circle": "Find all circles of a game and their basins of attraction.",
    "map": "Map the closest approach over initial poses; find the worst.",
    "bound": "Compute the best closest approach any evader can achieve.",
    "plan": "Plan one maneuver: footsteps, ZMP and CoM.",
}


@click.group(
    "theory",
    cls=LazyGroup,
    lazy=COMMANDS,
    module="theory",
    modules={"bound": "bound"},
)
def theory(**_: Any) -> None:
    """Compute what theory says of a game, or plan a maneuver."""


NAMED_OF_CIRCLE = ("speed", "gain", "angle", "law", "starts")
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
@takes_settings(NAMED_OF_CIRCLE, CircleSettings)
@figure_option(help="Write a figure of the circle over angle and ratios.")
@json_option
def circle(
    settings: CircleSettings, figure: Path | None, as_json: bool
) -> None:
    """Find the circles of a game, their stability and basins of attraction."""
    result = _describe_circle(settings)
    with ProgressLine("circle", settings.starts, "games", quiet=as_json) as b:
        result |= _find_circles(settings, b.update)
    print_json(result) if as_json else _print_circles(result)
    if figure is not None:
        from ..report.unicycle_figures import draw_sweep

        draw_sweep(settings.game, str(figure))


def _entries_of(found: Any) -> dict[str, Any]:
    """Return one circle for JSON."""
    entries: dict[str, Any] = plain(found)
    entries["eigenvalues_per_s"] = entries.pop("eigenvalues")
    return entries


def _describe_circle(settings: CircleSettings) -> dict[str, Any]:
    """Return the main circle for JSON, None where undefined.

    Stable means with sampling and delay; eigenvalues are those without.
    """
    from ..theory.unicycle import sampled_stability as sampled
    from ..theory.unicycle.circles import circle_of

    game, held, late = settings.game, settings.sample_time, settings.delay
    found = circle_of(game)
    result = _entries_of(found) | {
        "sample_time_s": held,
        "delay_s": late,
    }
    if found.sliding and (held or late):  # chattering: no linearisation
        result |= {"stable": None, "time_constant_s": None}
    elif found.exists and not found.sliding:
        rate = sampled.growth_rate(game, held, late)
        result["stable"] = rate < 0.0
        result["time_constant_s"] = plain(-1.0 / rate) if rate < 0.0 else None
        largest = sampled.largest_stable_sample_time(game, late)
        result["largest_stable_sample_time_s"] = plain(largest)
        result["largest_stable_delay_s"] = None
        with suppress(PlanError):  # sampling is too fine
            largest = sampled.largest_stable_delay(game, held)
            result["largest_stable_delay_s"] = plain(largest)
    return result | {"game": to_entries(game)}


def _find_circles(settings: CircleSettings, progress: Any) -> dict[str, Any]:
    """Return every circle, and the fraction of starts that end on it."""
    from ..theory.unicycle.circles import circles_of
    from ..theory.unicycle.start_maps import find_basins, random_starts

    game = settings.game
    circles, starts = circles_of(game), None
    shares: Sequence[float | None] = [None] * len(circles)
    if settings.starts:
        drawn = random_starts(game, settings.starts, seed=settings.seed)
        out = find_basins(
            game, drawn, capture_distance=settings.capture, progress=progress
        )
        shares = out.shares(len(circles))
        starts = {
            "number": settings.starts,
            "captured_share": float(out.captured.mean()),
            "unsettled_share": float(
                ((out.circle < 0) & ~out.captured).mean()
            ),
            "mean_closest_distance_m": float(out.closest_distance.mean()),
        }
    rows = [
        {
            "circle": CIRCLES[each.direction],
            "direction": each.direction,
            "side_rule": "behind" if each.behind else "latched",
            **_entries_of(each),
            "share": share,
        }
        for each, share in zip(circles, shares, strict=True)
    ]
    return {"circles": rows, "starts": starts}


def _print_circles(result: dict[str, Any]) -> None:
    """Print the main circle, then all circles as a table."""
    if result["exists"]:
        aside = ("circles", "game", "starts")
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


NAMED_OF_MAP = ("speed", "gain", "angle", "law", "nearest", "farthest", "grid")
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
    capture: float | None = setting(
        None,
        "Capture distance",
        positive("m", None),
        default_text="0.1 v/k",
    )


@click.command("map")
@takes_settings(NAMED_OF_MAP, StartMapSettings)
@figure_option()
@json_option
def map(  # noqa: A001 (the command's name)
    settings: StartMapSettings, figure: Path | None, as_json: bool
) -> None:
    """Simulate games over a grid of initial poses and find the worst one."""
    import numpy as np

    from ..theory.unicycle.circles import circles_of
    from ..theory.unicycle.start_maps import find_worst_start, map_starts

    game = settings.game
    unit = game.evader_speed / game.evader_gain
    near, far = settings.nearest or 1.6 * unit, settings.farthest or 4.0 * unit
    if far < near:
        raise click.UsageError(
            f"farthest must be >= nearest, {near:g} [m], got {far:g} [m]"
        )
    gain = min(game.pursuer_gain, game.evader_gain)
    duration = settings.duration or 30.0 / gain
    capture = settings.capture or 0.1 * unit
    axes = (
        np.linspace(near, far, settings.distances),
        np.linspace(-settings.aim, settings.aim, settings.grid),
        np.linspace(-settings.facing, settings.facing, settings.grid),
    )
    total = settings.distances * settings.grid**2
    with ProgressLine("map", total, "games", quiet=as_json) as bar:
        found = map_starts(
            *(game, axes, duration),
            capture_distance=capture,
            progress=bar.update,
        )
    start, closest = find_worst_start(
        game, found, duration, capture_distance=capture
    )
    out, circles = found.outcomes, circles_of(game)
    settled = out.settled_time[np.isfinite(out.settled_time)]
    times = settled if len(settled) else np.array([np.inf])
    shares = out.shares(len(circles))
    result = {
        "games": total,
        "min_distance_m": closest,
        "worst_start": {
            "distance_m": start.distance,
            "pursuer_error_rad": start.pursuer_error,
            "bearing_rad": start.bearing,
            "captured": bool(closest <= capture * (1.0 + 1e-9)),
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
        "capture_m": capture,
        "duration_s": duration,
        "game": to_entries(game),
    }
    print_json(result) if as_json else _print_map(result)
    if figure is not None:
        from ..report.unicycle_figures import draw_map

        draw_map(found, str(figure), circles=circles, body=capture)


def _print_map(result: dict[str, Any]) -> None:
    """Print the values, the worst start and the circles."""
    shown = {k: v for k, v in result.items() if k != "game"}
    print_table(result_rows(shown))
    if result["circles"]:
        echo()
        print_rows(result["circles"], ("circle", "distance_m", "share"))


ROLES = {"pursuer": Direction.FORWARD, "evader": Direction.BACKWARD}
FEET = {foot.name.lower(): foot for foot in Foot}


@dataclass(frozen=True, slots=True)
class PlanSettings(CheckedSettings, error=PlanError):
    """Settings of one maneuver."""

    role: str | None = setting(
        None,
        "Role: the pursuer walks forward, the evader backward",
        names=ROLES,
    )
    bearing: float | None = setting(
        None,
        "Desired heading in the frame of the support foot {unit}; 0 is "
        "straight ahead",
        Range(-pi, pi, "rad", "half a turn", also=(None,)),
    )
    steps: int = setting(
        20,
        "Number of footsteps",
        Range(1, 200, "steps", "more cannot be drawn", whole=True),
    )
    first_foot: str = setting(
        "left",
        "Foot that lands first",
        names=FEET,
    )
    saturated: bool = setting(
        False,
        "Turn by eq. (6) instead of eq. (8)",
    )
    gait: GaitSettings = setting(
        GaitSettings(),
        "Gait",
        presets=PRESETS,
    )


NAMED_OF_PLAN = ("role", "bearing", "steps", "first_foot", "saturated", "gait")


@click.command("plan")
@takes_settings(NAMED_OF_PLAN, PlanSettings)
@figure_option()
@json_option
def plan(settings: PlanSettings, figure: Path | None, as_json: bool) -> None:
    """Plan one maneuver from standing: path, footsteps, ZMP and CoM.

    --role and --bearing are required.
    """
    from ..planning import ManeuverPlanner, TemplateDrive

    role, bearing, gait = settings.role, settings.bearing, settings.gait
    if role is None:
        raise click.UsageError("missing option --role: pursuer or evader")
    if bearing is None:
        raise click.UsageError("missing option --bearing: like 60deg")
    maneuver = ManeuverPlanner(gait).plan(
        bearing,
        ROLES[role],
        first_foot=FEET[settings.first_foot],
        standing=True,
        drive=TemplateDrive(settings.saturated),
        count=settings.steps,
    )
    if as_json:
        print_json(_plan_entries(settings, maneuver))
    else:
        _print_plan(maneuver)
    if figure is not None:
        from ..report.plan_view import draw_plan

        draw_plan(maneuver, role, figure)


def _plan_entries(settings: PlanSettings, maneuver: "ManeuverPlan") -> Any:
    """Return all values of a maneuver for JSON."""
    import numpy as np

    schedule = maneuver.schedule
    times = np.arange(int(schedule.duration / 0.01 + 1e-9) + 1) * 0.01
    samples = maneuver.sample(times)
    return {
        "role": settings.role,
        "bearing_rad": settings.bearing,
        "frame": "support foot of the first step",
        "eta_per_s": settings.gait.eta,
        "margin_m": maneuver.margin(),
        "zmp_correction_m": maneuver.correction.tolist(),
        "phase_starts_s": schedule.starts.tolist(),
        "footsteps": [
            {
                "foot": step.foot.name.lower(),
                "x": step.x,
                "y": step.y,
                "theta": step.theta,
            }
            for step in maneuver.footsteps
        ],
        "times_s": samples.times.tolist(),
        "zmp": samples.zmp.tolist(),
        "com": samples.com.tolist(),
        "com_velocity": samples.com_velocity.tolist(),
        "dcm": samples.dcm.tolist(),
        "zmp_pieces": {
            "durations_s": schedule.durations.tolist(),
            "coefficients": maneuver.zmp_coefficients.tolist(),
        },
    }


def _print_plan(maneuver: "ManeuverPlan") -> None:
    print_columns(
        ("foot", "x [m]", "y [m]", "theta [deg]"),
        [
            (
                *(step.foot.name.lower(), f"{step.x:.4f}", f"{step.y:.4f}"),
                f"{degrees(step.theta):.2f}",
            )
            for step in maneuver.footsteps
        ],
        left=(0,),
    )
    echo(
        f"  {maneuver.schedule.duration:.2f} s; the ZMP stays "
        f"{1e3 * maneuver.margin():.1f} mm inside the support polygon"
    )
