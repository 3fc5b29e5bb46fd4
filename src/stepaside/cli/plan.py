"""``stepaside theory plan``: one maneuver as a table, a figure or JSON."""

from dataclasses import dataclass, fields
from math import degrees, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.errors import PlanError
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from ..games.game_settings import OF_ALL, GameSettings
from ..planning import PRESETS, Direction, Foot, GaitSettings
from .options import figure_option, json_option
from .settings import takes_settings
from .tables import print_columns
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..planning import ManeuverPlan

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


# Entries of games, which the file of a plan may contain; players have gaits.
ENTRIES_OF_GAMES = {
    *(*OF_ALL, *(each.name for each in fields(GameSettings))),
} - {"players"}

NAMED = ("role", "bearing", "steps", "first_foot", "saturated", "gait")


@click.command("plan")
@takes_settings(NAMED, aside=ENTRIES_OF_GAMES, settings=PlanSettings)
@figure_option()
@json_option
def plan(settings: PlanSettings, figure: Path | None, as_json: bool) -> None:
    """Plan one maneuver from standing: path, footsteps, ZMP and CoM.

    --role and --bearing are required. The gait may come from the file of a
    game that gives one to all its players.
    """
    from ..planning import ManeuverPlanner, TemplateDrive

    role, bearing, gait = settings.role, settings.bearing, settings.gait
    for name, value in (("--role", role), ("--bearing", bearing)):
        if value is None:
            raise click.UsageError(f"missing option {name}")
    assert role is not None and bearing is not None  # for the type checker
    maneuver = ManeuverPlanner(gait).plan(
        bearing,
        ROLES[role],
        first_foot=FEET[settings.first_foot],
        standing=True,
        drive=TemplateDrive(settings.saturated),
        count=settings.steps,
    )
    if as_json:
        print_json(_to_json(settings, maneuver))
    else:
        _print(maneuver)
    if figure is not None:
        from ..report.plan_view import draw_plan

        draw_plan(maneuver, role, figure)


def _to_json(settings: PlanSettings, maneuver: "ManeuverPlan") -> Any:
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


def _print(maneuver: "ManeuverPlan") -> None:
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
