"""``stepaside play --check``: check of a robot's class in Python."""

from typing import TYPE_CHECKING

import click

from .options.settings_options import refuse_options
from .terminal import echo, print_json

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..drivers.guardian_process import Guardian
    from ..drivers.joint_robot import JointRobot
    from ..drivers.method_check import AdapterFinding, MethodCheck
    from ..drivers.velocity_robot import VelocityRobot
    from .connection_settings import ConnectionSettings

SILENCE = 3.0  # of the check before its guardian stops the robot, in [s]
WALKS = (
    "the robot will turn and walk for about 20 s, at most at half of its "
    "limits: let it hang, or give it room; Ctrl-C stops it"
)
MOVES = (
    "each joint of the robot will move by 0.1 rad and back, for about {} s: "
    "let it hang in the air; Ctrl-C releases it"
)
PER_JOINT = 1.2  # duration of the check of a joint, in [s]


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
    from ..drivers.joint_robot import JointRobot
    from ..drivers.robot_loader import load_robot_class

    make = load_robot_class(connection.robot)

    def note(finding: "AdapterFinding") -> None:
        if not as_json:
            text = finding.text
            echo(f"{finding.verdict:<8} {finding.name:<17} {text}")

    if issubclass(make, JointRobot):
        check = _joint_check(make, connection, note)
    else:
        refuse_options({"description"}, "a robot that is driven by its joints")
        check = _velocity_check(make, connection, note)
    if as_json:
        found = [each._asdict() for each in check.findings]
        robot = {"robot": connection.robot, "passes": check.passes}
        print_json(robot | {"findings": found})
    if not check.passes:
        raise SystemExit(1)


def _velocity_check(
    make: "type[VelocityRobot]",
    connection: "ConnectionSettings",
    note: "Callable[[AdapterFinding], None]",
) -> "MethodCheck":
    """Run the check of a robot that is driven by velocities."""
    from ..drivers.robot_session import join_halter
    from ..drivers.velocity_check import VelocityCheck

    def join() -> "Callable[[], None]":
        robot = make()
        return join_halter(make, "stop") if robot.keeps_walking else _nothing

    guardian = _guardian(connection, WALKS, join)
    check = VelocityCheck(
        make(), note, dry_run=connection.dry_run, guardian=guardian
    )
    return _checked(check, guardian)


def _joint_check(
    make: "type[JointRobot]",
    connection: "ConnectionSettings",
    note: "Callable[[AdapterFinding], None]",
) -> "MethodCheck":
    """Run the check of a robot that is driven by its joints."""
    from ..drivers.joint_check import JointCheck
    from ..drivers.joint_robot import motors_of
    from ..drivers.robot_session import join_halter
    from ..robots.description import load_robot

    robot = make()
    motors = motors_of(robot, load_robot(connection.description))
    warning = MOVES.format(round(PER_JOINT * len(motors.names)))

    def join() -> "Callable[[], None]":
        holds = robot.keeps_targets and robot.paced
        return join_halter(make, "release") if holds else _nothing

    guardian = _guardian(connection, warning, join)
    check = JointCheck(
        *(robot, motors, note),
        dry_run=connection.dry_run,
        guardian=guardian,
    )
    return _checked(check, guardian)


def _guardian(
    connection: "ConnectionSettings",
    warning: str,
    join: "Callable[[], Callable[[], None]]",
) -> "Guardian | None":
    """Print a warning, and fork a guardian if the robot will move."""
    if connection.dry_run:
        return None
    from ..drivers.robot_session import fork_guardian

    echo(f"stepaside: {warning}", err=True)
    return fork_guardian(join, SILENCE)


def _nothing() -> None:
    """Do nothing: the robot halts by itself."""


def _checked(
    check: "MethodCheck", guardian: "Guardian | None"
) -> "MethodCheck":
    """Run a check, and dismiss its guardian."""
    try:
        check.run()
    finally:
        if guardian is not None:
            guardian.dismiss()
    return check
