"""``stepaside plan``: one maneuver, as a table, a figure and JSON."""

from pathlib import Path

import click

from .options import ANGLE, json_option, print_json


@click.command("plan")
@click.option(
    "--role",
    type=click.Choice(["pursuer", "evader"]),
    required=True,
    help="The pursuer walks forward, the evader backward.",
)
@click.option(
    "--bearing",
    type=ANGLE,
    required=True,
    help="Desired heading in the frame of the support foot.",
)
@click.option(
    "--steps", type=click.IntRange(1, 200), default=20, show_default=True
)
@click.option(
    "--first-foot",
    type=click.Choice(["left", "right"]),
    default="left",
    show_default=True,
)
@click.option(
    "--preset",
    type=click.Choice(["nao", "as-printed"]),
    default="nao",
    show_default=True,
    help="Gait: the NAO that walks, or the durations as printed.",
)
@click.option(
    "--profile",
    type=click.Choice(["linear", "cubic"]),
    default="linear",
    show_default=True,
    help="ZMP between the feet in double support.",
)
@click.option("--saturated", is_flag=True, help="Turn by (6) instead of (8).")
@click.option(
    "--figure", type=click.Path(dir_okay=False), help="Write a figure."
)
@json_option
def plan(
    role: str,
    bearing: float,
    steps: int,
    first_foot: str,
    preset: str,
    profile: str,
    saturated: bool,
    figure: str | None,
    as_json: bool,
) -> None:
    """Plan one maneuver from standing: path, footsteps, ZMP and CoM."""
    from dataclasses import replace
    from math import pi
    from typing import cast

    import numpy as np

    from ..errors import PlanError, check_within
    from ..planning import PRESETS, Direction, Foot, ManeuverPlanner

    check_within(bearing, -pi, pi, "bearing", "rad", PlanError)
    settings = replace(PRESETS[preset], zmp_profile=cast("object", profile))  # type: ignore[arg-type]
    planner = ManeuverPlanner(settings)
    direction = Direction.FORWARD if role == "pursuer" else Direction.BACKWARD
    maneuver = planner.plan(
        bearing,
        direction,
        first_foot=Foot[first_foot.upper()],
        standing=True,
        saturated=saturated,
        count=steps,
    )
    schedule = maneuver.schedule
    times = np.arange(int(schedule.duration / 0.01 + 1e-9) + 1) * 0.01
    samples = maneuver.sample(times)
    if as_json:
        print_json(
            {
                "role": role,
                "bearing_rad": bearing,
                "preset": preset,
                "frame": "support foot of the first step",
                "eta_per_s": settings.eta,
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
        click.echo("  foot       x [m]     y [m]  theta [deg]")
        for step in maneuver.footsteps:
            click.echo(
                f"  {step.foot.name.lower():<6} {step.x:9.4f} {step.y:9.4f}"
                f"  {np.degrees(step.theta):11.2f}"
            )
        click.echo(
            f"  {schedule.duration:.2f} s; the ZMP stays "
            f"{1e3 * maneuver.margin():.1f} mm inside the support polygon"
        )
    if figure is not None:
        from ..report.plan_figure import draw_plan

        draw_plan(maneuver, role, Path(figure))
        click.echo(f"figure: {figure}", err=as_json)
