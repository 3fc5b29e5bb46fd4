"""``stepaside robot check``: verification of a robot description."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..core.progress import counter, show_progress
from .options import figure_option, json_option, workers_option
from .tables import print_table
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..fitting.robot_verification import VerificationReport
    from ..robots.description import RobotDescription


@click.command("check")
@click.argument("folder")
@workers_option
@figure_option(help="Write an image of the standing robot with its soles.")
@json_option
def check(
    folder: str, workers: int | None, figure: Path | None, as_json: bool
) -> None:
    """Check whether the robot in FOLDER can play.

    Checks the description, then simulates walks forward, backward and
    turning, in open loop and with feedback. The exit status is 1 if a check
    fails.
    """
    from ..robots.description import load_robot

    description = load_robot(folder)
    report = _check(description, workers)
    if as_json:
        print_json({"robot": description.name} | report.to_json())
    else:
        _print(report)
    if figure is not None:
        from ..report.robot_figure import draw_robot

        draw_robot(description, figure)
    if not report.passes:
        raise SystemExit(1)


def _check(
    description: "RobotDescription", workers: int | None
) -> "VerificationReport":
    """Check with a progress bar on standard error."""
    from ..core.worker_pool import worker_pool
    from ..fitting.robot_verification import check_robot

    with (
        worker_pool(workers) as executor,
        show_progress("check", unit="walks") as bar,
    ):
        return check_robot(description, executor, counter(bar))


def _print(report: "VerificationReport") -> None:
    print_table(
        [(f.name, f"{f.verdict:<4}  {f.value}") for f in report.findings]
    )
    hints = [f for f in report.findings if f.hint]
    if hints:
        echo("")
    for finding in hints:
        echo(f"{finding.name}: {finding.hint}")
    passed = "all checks passed: the robot can play"
    echo(f"\n{passed if report.passes else 'the robot cannot play yet'}")
