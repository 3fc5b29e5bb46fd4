"""``stepaside robustness --kind person``: people who come."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from .campaign_reports import CampaignOutcome, gather
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
    """Let people come, with a progress bar.

    Args:
        settings: How the robot walks; its seed is the first one.
        sensings: How it sees.
        seeds: Number of each who comes.
        file: Results that are done, which grows; None keeps nothing.
        workers: Processes.

    Returns:
        What was found so far, and how it ended.
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

        ended = gather(
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
    output: Path, asked: dict[str, Any], answer: dict[str, Any]
) -> None:
    """Write the results of a whole campaign and their map.

    Args:
        output: Folder, which exists.
        asked: What was asked for.
        answer: Of :func:`meet_people`.

    Raises:
        OutputError: If a file cannot be written.
    """
    from ..report.people_figure import draw_people
    from ..studies.result_files import header, write_result

    write_result(output / "people.json", header(asked), **answer)
    clearance = answer["clearance_m"]
    draw_people(answer["origins"], clearance, output / "people.png")


def print_people(answer: dict[str, Any]) -> None:
    """Print who came, and who only passed."""
    head = ("seen by", "speed", "contacts", "closest", "template", "room")
    echo("{:<8} {:>9} {:>9} {:>8} {:>9} {:>8}".format(*head))
    for row in answer["people"]:
        template = row["template_closest_m"]
        told = "-" if template is None else f"{template:.2f} m"
        echo(
            f"{row['sensing']:<8} {row['speed_m_s']:>5g} m/s "
            f"{row['contacts']:>4}/{row['number']:<4} "
            f"{row['closest_m']:>6.2f} m {told:>9} "
            f"{row['theory_room_m']:>6.2f} m"
        )
    for row in answer["passers_by"]:
        echo(
            f"{row['sensing']}: {row['false_triggers']} false triggers with "
            f"{row['number']} passers-by, "
            f"{row['false_triggers_per_hour']:.1f} an hour"
        )
