"""``stepaside robot legs measure``: velocities that learned legs deliver."""

from dataclasses import replace
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import atomic_draft
from ..core.progress import counter, show_progress
from .options import (
    figure_option,
    json_option,
    seed_option,
    workers_option,
)
from .tables import (
    format_value,
    print_columns,
    print_table,
    result_rows,
)
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..fitting.legs_measurement import LegsMeasurement
    from ..locomotion.control_settings import LegsSettings
    from ..robots.description import RobotDescription
    from ..sim.body_settings import BodySettings

BODIES = ("ideal", "delayed", "hardware")


@click.command("measure")
@click.argument("robot")
@click.option(
    "--legs",
    default="",
    help="ONNX file of the walking policy; that of robot.toml by default.",
)
@click.option("--legs-contract", default="", help="Name of the convention.")
@click.option(
    "--body",
    type=click.Choice(BODIES),
    default="ideal",
    help="Imperfections of the body.  [default: ideal]",
)
@click.option(
    "--delay-cycles",
    type=click.IntRange(0, 100),
    help="Delay from command to motion, in control cycles of the body; that "
    "of the body by default.",
)
@click.option(
    "--random-walks",
    type=click.IntRange(0, 1000),
    default=0,
    help="Also walk so many times for 60 s at random commands, and count "
    "falls.  [default: 0]",
)
@seed_option(help="Seed of sensor errors.")
@workers_option
@figure_option(help="Write a figure of commands and delivered velocities.")
@json_option
def measure(
    robot: str,
    legs: str,
    legs_contract: str,
    body: str,
    delay_cycles: int | None,
    random_walks: int,
    seed: int,
    workers: int | None,
    figure: Path | None,
    as_json: bool,
) -> None:
    """Walk the learned legs of ROBOT at a grid of commands.

    Each walk begins and ends at rest. Writes the response beside the robot
    description, as legs-NETWORK.toml, in place of an earlier one; games then
    command its inverse, so that intended and delivered velocities agree.
    """
    import tomli_w

    from ..games.robot_settings import (
        body_of_robot,
        settings_from_description,
    )
    from ..locomotion.control_settings import LegsSettings
    from ..locomotion.policy.velocity_response import (
        response_entries,
        response_path,
    )
    from ..robots.description import load_robot

    description = load_robot(robot)
    network = legs or settings_from_description(description).legs.network
    if not network:
        raise click.UsageError(
            "--legs must name a network: robot.toml has no [locomotion]"
        )
    settings = LegsSettings(network, legs_contract)
    file = response_path(description.folder, Path(network))
    walked = body_of_robot(description.folder, body)
    if delay_cycles is not None:
        walked = replace(walked, delay_cycles=delay_cycles)
    result = _measure(
        description, settings, walked, (seed, random_walks), workers
    )
    with atomic_draft(file) as draft:
        entries = response_entries(result.response, Path(network))
        draft.write_text(tomli_w.dumps(entries), encoding="utf-8")
    facts = measurement_facts(result) | {"file": str(file)}
    print_json(facts) if as_json else _print(facts)
    if figure is not None:
        from ..report.study_figures import draw_response

        draw_response(result.response, figure)


def _measure(
    description: "RobotDescription",
    legs: "LegsSettings",
    body: "BodySettings",
    draws: tuple[int, int],
    workers: int | None,
) -> "LegsMeasurement":
    """Measure with a progress bar on standard error.

    Args:
        description: Description of the robot.
        legs: Walking policy.
        body: Imperfections of the body.
        draws: Seed, and number of walks at random commands.
        workers: Number of processes.
    """
    from ..core.worker_pool import worker_pool
    from ..fitting.legs_measurement import measure_legs

    with (
        worker_pool(workers) as executor,
        show_progress("measure", unit="walks") as bar,
    ):
        return measure_legs(
            description,
            legs,
            body,
            executor,
            counter(bar),
            seed=draws[0],
            random_walks=draws[1],
        )


def measurement_facts(result: "LegsMeasurement") -> dict[str, Any]:
    """Return a measurement as JSON values; NaN becomes None."""

    def number(value: float) -> float | None:
        return value if isfinite(value) else None

    velocities = result.response.velocities
    return {
        "falls": result.falls,
        "gains": result.gains().tolist(),
        "limits": velocities.bounds,
        "tube_m": velocities.tube,
        "lag_s": [axis.lag for axis in result.response.axes],
        "halting": [axis.halting for axis in result.response.axes],
        "odometry_ratio": result.response.odometry_ratio,
        "random_walks": {
            "walks": len(result.random_walks),
            "falls_at_s": [t for t in result.random_walks if t is not None],
        },
        "combined_error_m_s": result.combined_error[0],
        "combined_error_rad_s": result.combined_error[1],
        "trials": [
            {
                "command": list(trial.command),
                "delivered": [number(value) for value in trial.delivered],
                "lag_s": number(trial.lag),
                "halting": number(trial.halting),
                "fell_at_s": trial.fell_at,
            }
            for trial in result.trials
        ],
    }


def _print(facts: dict[str, Any]) -> None:
    """Print the trials, then the response by axis."""
    print_columns(
        ("command", "delivered [m/s, m/s, rad/s]", "fell at"),
        [
            (
                _numbers(trial["command"]),
                _numbers(trial["delivered"]),
                format_value("fell_at_s", trial["fell_at_s"], 3),
            )
            for trial in facts["trials"]
        ],
        left=(),
    )
    echo("")
    print_table(result_rows(facts))


def _numbers(values: list[float | None]) -> str:
    return " ".join("-" if x is None else f"{x:7.3f}" for x in values)
