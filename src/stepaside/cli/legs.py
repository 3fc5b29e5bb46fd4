"""``stepaside robot legs``: inspect and measure walking policies."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import atomic_draft
from ..core.progress import ProgressLine
from .main import LazyGroup
from .options import (
    figure_option,
    file_argument,
    seed_option,
    workers_option,
)
from .tables import plain, print_columns, print_table, result_rows
from .terminal import echo, json_option, print_json

if TYPE_CHECKING:
    from ..fitting.legs_measurement import LegsMeasurement
    from ..locomotion.policy.contract_reader import ContractReading

COMMANDS = {
    "inspect": "Print the contract of a walking policy.",
    "measure": "Measure the velocities that learned legs deliver.",
}
BODIES = ("ideal", "delayed", "hardware")
PER_JOINT_COLUMNS = {
    "default_posture": "default posture [rad]",
    "stiffness": "stiffness [N m/rad]",
    "damping": "damping [N m s/rad]",
    "action_scale": "action scale [rad]",
}
contract_option = click.option(
    "--legs-contract", default="", help="Name of the convention."
)


@click.group("legs", cls=LazyGroup, lazy=COMMANDS, module="legs")
def legs(**_: Any) -> None:
    """Inspect a walking policy, or measure how a robot walks."""


@click.command("inspect")
@file_argument("network")
@click.option(
    "--robot", help="Robot that walks: a name, or folder of a description."
)
@contract_option
@json_option
def inspect(
    network: Path, robot: str | None, legs_contract: str, as_json: bool
) -> None:
    """Print the contract of the walking policy NETWORK (ONNX).

    Says for each value where it comes from, and names what is missing, does
    not fit the network or the robot, or is implausible. The exit status is 2
    if the network cannot run.
    """
    from ..locomotion.policy.contract_reader import RobotJoints, read_contract
    from ..locomotion.policy.runner import PolicyNetwork

    loaded, joints = PolicyNetwork(network), RobotJoints()
    if robot is not None:
        from ..robots.description import load_robot

        joints = RobotJoints.of(load_robot(robot))
    reading = read_contract(loaded, joints, legs_contract)
    if as_json:
        print_json(_facts(reading))
    else:
        _print(reading)
        for finding in reading.findings:
            echo(f"{finding.severity}: {finding.text}")
        if not reading.findings:
            echo("no findings")
    reading.check()


def _facts(reading: "ContractReading") -> dict[str, Any]:
    """Return contract and network as JSON values."""
    from ..games.settings_reader import settings_entries

    used, network = reading.convention, reading.network
    return {
        "network": str(network.path),
        "input": str(network.observation),
        "output": str(network.action),
        "recurrent": [str(given) for given, _ in network.states],
        "convention": None if used is None else used.name,
        "source": None if used is None else used.source,
        "contract": plain(settings_entries(reading.values)),
        "sources": reading.sources,
        "findings": [each._asdict() for each in reading.findings],
    }


def _print(reading: "ContractReading") -> None:
    """Print the contract as tables, each value with its source."""
    values, sources, network = reading.values, reading.sources, reading.network
    rows = [
        ("input", str(network.observation)),
        ("output", str(network.action)),
    ]
    rows += [("recurrent state", str(given)) for given, _ in network.states]
    rows += [
        (name, f"{_text(name, values[name])}  ({sources[name]})")
        for name in values
        if name not in (*PER_JOINT_COLUMNS, "joints")
    ]
    print_table(rows)
    joints = values.get("joints", ())
    names = [name for name in PER_JOINT_COLUMNS if name in values]
    if not joints:
        return
    echo("")
    heads = [f"joints ({sources['joints']})"]
    heads += [f"{PER_JOINT_COLUMNS[n]} ({sources[n]})" for n in names]
    cells = [
        [joint]
        + [
            f"{values[name][i]:.4g}" if i < len(values[name]) else ""
            for name in names
        ]
        for i, joint in enumerate(joints)
    ]
    print_columns(heads, cells, left=(0,))


def _text(name: str, value: Any) -> str:
    """Return a value of a contract as text for the table."""
    if name == "terms":
        return ", ".join(
            term.name
            if set(term.scale) == {1.0}
            else f"{term.name} x {'/'.join(f'{s:g}' for s in term.scale)}"
            for term in value
        )
    if hasattr(value, "_asdict") or hasattr(value, "__dataclass_fields__"):
        return ", ".join(
            f"{name} {own:.3g}" if isinstance(own, float) else f"{name} {own}"
            for name, own in plain(value).items()
        )
    return f"{value:g}" if isinstance(value, float) else str(value)


@click.command("measure")
@click.argument("robot")
@click.option(
    "--legs",
    "network",
    default="",
    help="ONNX file of the walking policy; that of robot.toml by default.",
)
@contract_option
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
@seed_option(help="Seed of sensor errors.")
@workers_option
@figure_option(help="Write a figure of commands and delivered velocities.")
@json_option
def measure(
    robot: str,
    network: str,
    legs_contract: str,
    body: str,
    delay_cycles: int | None,
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

    from ..core.worker_pool import worker_pool
    from ..fitting.legs_measurement import measure_legs
    from ..games.player_settings import (
        settings_from_description,
    )
    from ..games.robot_bodies import body_of_robot
    from ..locomotion.control_settings import LegsSettings
    from ..locomotion.policy.velocity_response import (
        response_entries,
        response_path,
    )
    from ..robots.description import load_robot

    description = load_robot(robot)
    network = network or settings_from_description(description).legs.network
    if not network:
        raise click.UsageError(
            "--legs must name a network: robot.toml has no [locomotion]"
        )
    file = response_path(description.folder, Path(network))
    walked = body_of_robot(description.folder, body)
    if delay_cycles is not None:
        walked = replace(walked, delay_cycles=delay_cycles)
    with (
        worker_pool(workers) as executor,
        ProgressLine("measure", unit="walks") as bar,
    ):
        result = measure_legs(
            description,
            LegsSettings(network, legs_contract),
            walked,
            executor,
            bar.show,
            seed=seed,
        )
    with atomic_draft(file) as draft:
        entries = response_entries(result.response, Path(network))
        draft.write_text(tomli_w.dumps(entries), encoding="utf-8")
    facts = measurement_facts(result) | {"file": str(file)}
    if as_json:
        print_json(facts)
    else:
        print_columns(
            ("command", "delivered [m/s, m/s, rad/s]", "fell at [s]"),
            [
                (
                    _numbers(trial["command"].values()),
                    _numbers(trial["delivered"].values()),
                    _numbers([trial["fell_at_s"]]),
                )
                for trial in facts["trials"]
            ],
            left=(),
        )
        echo("")
        print_table(result_rows(facts))
    if figure is not None:
        from ..report.study_figures import draw_response

        draw_response(result.response, figure)


def measurement_facts(result: "LegsMeasurement") -> dict[str, Any]:
    """Return a measurement as JSON values; NaN becomes None."""
    response = result.response
    facts: dict[str, Any] = plain(
        {
            "falls": result.falls,
            "gains": result.gains().tolist(),
            "limits": response.velocities.bounds,
            "tube_m": response.velocities.tube,
            "reach_m": response.reach,
            "loss_m": response.loss,
            "drift_m": response.drift,
            "lag_s": [axis.lag for axis in response.axes],
            "halting": [axis.halting for axis in response.axes],
            "odometry_ratio": response.odometry_ratio,
            "trials": [
                {
                    "command": trial.command,
                    "delivered": trial.delivered,
                    "lag_s": trial.lag,
                    "halting": trial.halting,
                    "fell_at_s": trial.fell_at,
                }
                for trial in result.trials
            ],
        }
    )
    return facts


def _numbers(values: Iterable[float | None]) -> str:
    return " ".join("-" if x is None else f"{x:7.3f}" for x in values)
