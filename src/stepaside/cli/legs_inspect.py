"""``stepaside robot legs inspect``: a policy's contract."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .options import file_argument, json_option
from .tables import print_table
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..locomotion.policy.contract_reader import ContractReading


@click.command("inspect")
@file_argument("network")
@click.option(
    "--robot", help="Robot that walks: a name, or folder of a description."
)
@click.option("--legs-contract", default="", help="Name of the convention.")
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
    from ..games.configuration_file import json_settings

    used, network = reading.convention, reading.network
    return {
        "network": str(network.path),
        "input": str(network.observation),
        "output": str(network.action),
        "recurrent": [str(given) for given, _ in network.states],
        "convention": None if used is None else used.name,
        "source": None if used is None else used.source,
        "contract": json_settings(reading.values),
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
    columns = [name for name in PER_JOINT_COLUMNS if name in values]
    if not joints:
        return
    echo(f"\njoints ({sources['joints']}):")
    for name in columns:
        echo(f"  {PER_JOINT_COLUMNS[name]} ({sources[name]})")
    for i, joint in enumerate(joints):
        numbers = (
            f"{values[name][i]:10.4g}" if i < len(values[name]) else " " * 10
            for name in columns
        )
        echo(f"  {joint:28s}{''.join(numbers)}")


PER_JOINT_COLUMNS = {
    "default_posture": "default posture [rad]",
    "stiffness": "stiffness [N m/rad]",
    "damping": "damping [N m s/rad]",
    "action_scale": "action scale [rad]",
}


def _text(name: str, value: Any) -> str:
    """Return a value of a contract as text for the table."""
    if name == "terms":
        return ", ".join(
            term.name
            if set(term.scale) == {1.0}
            else f"{term.name} x {'/'.join(f'{s:g}' for s in term.scale)}"
            for term in value
        )
    if name == "clock":
        if value is None:
            return "none"
        phases = ", ".join(f"{x:.3g}" for x in value.offsets)
        after = f", after {value.settling:g} s" if value.settling else ""
        changes = f", changed by {value.spread:g} /s" if value.spread else ""
        return (
            f"{value.period:.3g} s{changes}, phases {phases} rad, "
            f"{value.standing} while standing{after}"
        )
    if name == "command_ranges":
        limits = (
            f"{k} {a:g} to {b:g}" for k, (a, b) in value._asdict().items()
        )
        return ", ".join(limits)
    return f"{value:g}" if isinstance(value, float) else str(value)
