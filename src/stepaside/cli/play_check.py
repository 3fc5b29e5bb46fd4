"""``stepaside play --check``: check of a robot's class in Python."""

from typing import TYPE_CHECKING

import click

from .settings import refuse_settings
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..drivers.robot_check import AdapterFinding
    from ..games.play_settings import PlaySettings

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


def check_adapter(settings: "PlaySettings", *, as_json: bool) -> None:
    """Check a robot; print a verdict per line; exit with 1 if one fails."""
    if not settings.in_python:
        raise click.UsageError(
            "--check requires the address FILE.py:CLASS, got "
            f"{settings.address!r}"
        )
    from ..drivers.guardian_process import fork_guardian
    from ..drivers.joint_motion import motors_of
    from ..drivers.robot import JointRobot
    from ..drivers.robot_check import RobotCheck
    from ..drivers.robot_loader import load_robot_class
    from ..robots.description import load_robot

    def note(finding: "AdapterFinding") -> None:
        if not as_json:
            text = finding.text
            echo(f"{finding.verdict:<8} {finding.name:<17} {text}")

    make = load_robot_class(settings.address)
    robot, dry_run, motors = make(), settings.dry_run, None
    if isinstance(robot, JointRobot):
        motors = motors_of(robot, load_robot(settings.robot))
        warning = MOVES.format(round(PER_JOINT * len(motors.names)))
    else:
        refuse_settings(("robot",), "a robot that is driven by its joints")
        warning = WALKS
    guardian = None
    if not dry_run:
        echo(f"stepaside: {warning}", err=True)
        if robot.paced:
            guardian = fork_guardian(make, robot, SILENCE)
    check = RobotCheck(robot, motors, note, dry_run=dry_run, guardian=guardian)
    try:
        check.run()
    finally:
        if guardian is not None:
            guardian.dismiss()
    if as_json:
        found = [each._asdict() for each in check.findings]
        summary = {"robot": settings.address, "passes": check.passes}
        print_json(summary | {"findings": found})
    if not check.passes:
        raise SystemExit(1)
