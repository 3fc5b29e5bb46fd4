"""``stepaside play --check``: check of a robot's class in Python."""

from typing import TYPE_CHECKING

import click

from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..drivers.velocity.adapter_check import AdapterFinding
    from .connection_settings import ConnectionSettings

SILENCE = 3.0  # of the check before its guardian stops the robot, in [s]
WARNING = (
    "the robot will turn and walk for about 20 s, at most at half of its "
    "limits: let it hang, or give it room; Ctrl-C stops it"
)


def check_adapter(connection: "ConnectionSettings", *, as_json: bool) -> None:
    """Check a robot, print a verdict per line, and exit with 1 if one fails.

    Args:
        connection: Robot, and whether nothing is commanded.
        as_json: Whether to print one JSON object.

    Raises:
        SystemExit: If a check failed.
    """
    if not connection.in_python:
        raise click.UsageError(
            f"--check requires --robot FILE.py:CLASS, got {connection.robot!r}"
        )
    from ..drivers.robot_loader import load_robot_class
    from ..drivers.velocity.adapter_body import connect_adapter_stopper
    from ..drivers.velocity.adapter_check import AdapterCheck
    from ..drivers.velocity.velocity_guardian import fork_velocity_guardian
    from ..drivers.velocity.velocity_robot import VelocityRobot

    make = load_robot_class(connection.robot)
    if not issubclass(make, VelocityRobot):
        raise click.UsageError(
            "--check requires a VelocityRobot; of a JointRobot, --dry-run "
            f"reads and judges the reports, got {connection.robot!r}"
        )
    guardian = None
    if not connection.dry_run:
        echo(f"stepaside: {WARNING}", err=True)
        guardian = fork_velocity_guardian(
            lambda: connect_adapter_stopper(make), SILENCE
        )

    def note(finding: "AdapterFinding") -> None:
        if not as_json:
            text = finding.text
            echo(f"{finding.verdict:<8} {finding.name:<17} {text}")

    check = AdapterCheck(
        make(), note, dry_run=connection.dry_run, guardian=guardian
    )
    try:
        check.run()
    finally:
        if guardian is not None:
            guardian.dismiss()
    if as_json:
        found = [each._asdict() for each in check.findings]
        robot = {"robot": connection.robot, "passes": check.passes}
        print_json(robot | {"findings": found})
    if not check.passes:
        raise SystemExit(1)
