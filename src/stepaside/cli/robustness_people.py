"""``stepaside robustness --kind person``: encounters with people."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from .campaign_reports import CampaignOutcome, run_campaign_work
from .progress import show_progress
from .terminal import echo

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings


def meet_people(
    settings: "WalkSettings",
    sensings: tuple[str, ...],
    seeds: int,
    file: Path | None,
    workers: int | None,
) -> tuple[dict[str, Any], CampaignOutcome]:
    """Simulate encounters with people, with a progress bar.

    Args:
        settings: Settings of the robot; its seed is the first one.
        sensings: Kinds of sensing.
        seeds: Number of encounters of each kind.
        file: Record file; None records nothing.
        workers: Number of processes; all cores if None.

    Returns:
        The results so far, and how the campaign ended.
    """
    from ..core.worker_pool import worker_pool
    from ..studies.people_campaign import encounters, run_encounters
    from ..studies.people_statistics import (
        origin_rows,
        passing_rows,
        people_rows,
    )
    from ..studies.robustness_campaign import stamp

    grid = list(encounters(settings, sensings, seeds=seeds))
    done: dict[str, Any] = {}
    with (
        show_progress("people", len(grid), "games") as bar,
        worker_pool(workers) as executor,
    ):

        def report(number: int) -> None:
            bar.n = number
            bar.refresh()

        ended = run_campaign_work(
            lambda: run_encounters(grid, file, executor, report, done),
            file,
            lambda: {key: record | stamp() for key, record in done.items()},
        )
    return {
        "planned": len(grid),
        "done": len(done),
        "clearance_m": grid[0].base.strategy.clearance,
        "people": people_rows(grid, done),
        "passers_by": passing_rows(grid, done),
        "origins": origin_rows(grid, done),
    }, ended


def write_people(
    output: Path, request: dict[str, Any], answer: dict[str, Any]
) -> None:
    """Write the results of a complete campaign and their figure.

    Args:
        output: Existing folder.
        request: Settings of the campaign, for the header of the results.
        answer: Results of :func:`meet_people`.

    Raises:
        OutputError: If a file cannot be written.
    """
    from ..report.people_figure import draw_people
    from ..studies.result_files import header, write_result

    write_result(output / "people.json", header(request), **answer)
    clearance = answer["clearance_m"]
    draw_people(answer["origins"], clearance, output / "people.png")


def print_people(answer: dict[str, Any]) -> None:
    """Print encounters with approaching and with passing people."""
    head = ("sensing", "speed", "contacts", "closest", "template", "theory")
    echo("{:<8} {:>9} {:>9} {:>8} {:>9} {:>8}".format(*head))
    for row in answer["people"]:
        template = row["template_closest_m"]
        simulated = "-" if template is None else f"{template:.2f} m"
        echo(
            f"{row['sensing']:<8} {row['speed_m_s']:>5g} m/s "
            f"{row['contacts']:>4}/{row['number']:<4} "
            f"{row['closest_m']:>6.2f} m {simulated:>9} "
            f"{row['theory_room_m']:>6.2f} m"
        )
    for row in answer["passers_by"]:
        echo(
            f"{row['sensing']}: {row['false_triggers']} false triggers with "
            f"{row['number']} passing pedestrians, "
            f"{row['false_triggers_per_hour']:.1f} per hour"
        )
