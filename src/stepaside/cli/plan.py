"""``stepaside plan``: one maneuver as a table, a figure or JSON."""

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .options.common_options import FIGURE, figure_width, json_option
from .options.declaration import OptionDeclaration, OptionGroup
from .options.gait_options import BEARING, GAIT, HORIZON
from .options.settings_command import SettingsCommand, takes_settings
from .output_files import attempt, writes_files
from .terminal import echo
from .value_types import print_json

if TYPE_CHECKING:
    from .plan_settings import PlanSettings


def _plan_settings() -> "type[PlanSettings]":
    from .plan_settings import PlanSettings

    return PlanSettings


def _roles() -> Collection[str]:
    from .plan_settings import ROLES

    return tuple(ROLES)


def _feet() -> Collection[str]:
    from .plan_settings import FEET

    return tuple(FEET)


def _others() -> Collection[str]:
    from .plan_settings import entries_of_others

    return entries_of_others()


MANEUVER = OptionGroup(
    "Maneuver",
    (
        OptionDeclaration(
            "--role",
            "The pursuer walks forward, the evader backward.",
            "role",
            registry=_roles,
        ),
        BEARING,
        OptionDeclaration(
            "--steps", "Number of footsteps.", "steps", kind=click.INT
        ),
        OptionDeclaration(
            "--first-foot",
            "Foot that lands first.",
            "first_foot",
            registry=_feet,
        ),
        OptionDeclaration(
            "--saturated/--no-saturated",
            "Turn by eq. (6) instead of eq. (8).",
            "saturated",
        ),
    ),
)


@click.command("plan", cls=SettingsCommand)
@takes_settings(
    _plan_settings, MANEUVER, GAIT.without(HORIZON), ignored=_others
)
@FIGURE.option()
@figure_width
@json_option
@writes_files
def plan(settings: "PlanSettings", figure: str | None, as_json: bool) -> None:
    """Plan one maneuver from standing: path, footsteps, ZMP and CoM.

    --role and --bearing are required. The gait may come from the
    configuration of a duel or a walk.
    """
    import numpy as np

    from ..planning import ManeuverPlanner
    from .plan_settings import FEET, ROLES

    role, bearing, gait = settings.role, settings.bearing, settings.gait
    for name, value in (("--role", role), ("--bearing", bearing)):
        if value is None:
            raise click.UsageError(f"Missing option '{name}'.")
    assert role is not None and bearing is not None  # for the type checker
    maneuver = ManeuverPlanner(gait).plan(
        bearing,
        ROLES[role],
        first_foot=FEET[settings.first_foot],
        standing=True,
        saturated=settings.saturated,
        count=settings.steps,
    )
    schedule = maneuver.schedule
    times = np.arange(int(schedule.duration / 0.01 + 1e-9) + 1) * 0.01
    samples = maneuver.sample(times)
    if as_json:
        print_json(
            {
                "role": role,
                "bearing_rad": bearing,
                "preset": settings.preset,
                "frame": "support foot of the first step",
                "eta_per_s": gait.eta,
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
        )
    else:
        echo("  foot       x [m]     y [m]  theta [deg]")
        for step in maneuver.footsteps:
            echo(
                f"  {step.foot.name.lower():<6} {step.x:9.4f} {step.y:9.4f}"
                f"  {np.degrees(step.theta):11.2f}"
            )
        echo(
            f"  {schedule.duration:.2f} s; the ZMP stays "
            f"{1e3 * maneuver.margin():.1f} mm inside the support polygon"
        )
    if figure is not None:
        from ..report.plan_figure import draw_plan

        if attempt(lambda: draw_plan(maneuver, role, Path(figure))):
            echo(f"figure: {figure}", err=as_json)
