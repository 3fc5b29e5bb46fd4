"""``stepaside robustness --kind person``: encounters with people."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from .campaign_options import CampaignOptions
from .campaign_reports import run_campaign
from .terminal import echo

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings
    from ..locomotion.policy.legs_settings import LegsSettings
    from ..studies.campaign import StudyRun


def meet_people(
    settings: "WalkSettings",
    sensings: tuple[str, ...],
    seeds: int,
    legs: "LegsSettings",
    campaign: CampaignOptions,
) -> "tuple[dict[str, Any], StudyRun[Any]]":
    """Simulate encounters with people, with a progress bar.

    Args:
        settings: Settings of the robot; its seed is the first one.
        sensings: Kinds of sensing.
        seeds: Number of encounters of each kind.
        legs: Walking policy of the robot, if it walks by one.
        campaign: Options of the campaign.

    Returns:
        The results so far, and the run of the study.
    """
    from ..studies.people_campaign import people_study
    from ..studies.people_statistics import (
        origin_rows,
        passing_rows,
        people_rows,
    )
    from ..studies.person_encounters import encounters

    grid = list(encounters(settings, sensings, seeds=seeds, legs=legs))
    run = run_campaign(people_study(grid), campaign, "games")
    found = list(run.items())
    return {
        "planned": len(run.study.cases),
        "done": run.finished,
        "clearance_m": grid[0].base.strategy.clearance,
        "people": people_rows(found),
        "passers_by": passing_rows(found),
        "origins": origin_rows(found),
    }, run


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
        room = row["theory_room_m"]
        in_theory = "-" if room is None else f"{room:.2f} m"
        echo(
            f"{row['sensing']:<8} {row['speed_m_s']:>5g} m/s "
            f"{row['contacts']:>4}/{row['number']:<4} "
            f"{row['closest_m']:>6.2f} m {simulated:>9} "
            f"{in_theory:>8}"
        )
    for row in answer["passers_by"]:
        echo(
            f"{row['sensing']}: {row['false_triggers']} false triggers with "
            f"{row['number']} passing pedestrians, "
            f"{row['false_triggers_per_hour']:.1f} per hour"
        )
