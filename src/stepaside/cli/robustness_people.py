"""``stepaside robustness --kind person``: encounters with people."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..strategies.shield_settings import ShieldSettings
from .campaign_options import CampaignOptions
from .campaign_reports import run_campaign
from .terminal import echo

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings
    from ..locomotion.policy.legs_settings import LegsSettings
    from ..studies.campaign import StudyRun


@dataclass(frozen=True, slots=True)
class PeopleRequest:
    """People whom a robot meets.

    Attributes:
        sensings: Kinds of sensing.
        seeds: Number of encounters of each kind.
        legs: Walking policy of the robot, if it walks by one.
        strategy: Strategy of the robot; empty for that of its legs.
        reactions: What people do near the robot; empty for everything.
        number: Number of people drawn at random instead of a grid; 0 for the
            grid.
        shield: Shield of the robot.
    """

    sensings: tuple[str, ...]
    seeds: int
    legs: "LegsSettings"
    strategy: str = ""
    reactions: tuple[str, ...] = ()
    number: int = 0
    shield: ShieldSettings = ShieldSettings()


def meet_people(
    settings: "WalkSettings",
    request: PeopleRequest,
    campaign: CampaignOptions,
) -> "tuple[dict[str, Any], StudyRun[Any]]":
    """Simulate encounters with people, with a progress bar.

    Args:
        settings: Settings of the robot; its seed is the first one.
        request: The people.
        campaign: Options of the campaign.

    Returns:
        The results so far, and the run of the study.
    """
    from ..studies.drawn_encounters import drawn_study
    from ..studies.people_campaign import people_study
    from ..studies.people_statistics import (
        origin_rows,
        passing_rows,
        people_rows,
        reaction_rows,
    )
    from ..studies.person_encounters import (
        LADDER,
        base_settings,
        encounters,
    )

    base = base_settings(
        settings, request.legs, request.strategy, request.shield
    )
    if request.number:
        base = replace(base, seed=settings.seed)
        (sensing,) = request.sensings
        drawn = run_campaign(
            drawn_study(base, sensing, request.number), campaign, "games"
        )
        return {
            "planned": len(drawn.study.cases),
            "done": drawn.finished,
            "reactions": reaction_rows(drawn.items()),
        }, drawn
    grid = encounters(
        settings,
        request.sensings,
        seeds=request.seeds,
        legs=request.legs,
        strategy=request.strategy,
        shield=request.shield,
        reactions=request.reactions or LADDER,
    )
    run = run_campaign(people_study(list(grid)), campaign, "games")
    found = list(run.items())
    return {
        "planned": len(run.study.cases),
        "done": run.finished,
        "clearance_m": base.strategy.clearance,
        "people": people_rows(found),
        "passers_by": passing_rows(found),
        "reactions": reaction_rows(found),
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
    if answer.get("origins"):
        clearance = answer["clearance_m"]
        draw_people(answer["origins"], clearance, output / "people.png")


def print_people(answer: dict[str, Any]) -> None:
    """Print encounters with approaching and with passing people."""
    if answer.get("people"):
        head = ("sensing", "speed", "contacts", "closest", "template")
        echo("{:<8} {:>9} {:>9} {:>8} {:>9}   theory".format(*head))
    for row in answer.get("people", ()):
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
    for row in answer.get("passers_by", ()):
        echo(
            f"{row['sensing']}: {row['false_triggers']} false triggers with "
            f"{row['number']} passing pedestrians, "
            f"{row['false_triggers_per_hour']:.1f} per hour"
        )
    echo(
        f"\n{'sensing':<8} {'reaction':<22} {'contacts':>8} {'95 %':>8} "
        f"{'falls':>5} {'closest':>9}  causes"
    )
    for row in answer["reactions"]:
        causes = ", ".join(f"{n} {c}" for c, n in row["causes"].items())
        kind = row["reaction"] + (" (searched)" if row["hard"] else "")
        low, high = row["contacts_low"], row["contacts_high"]
        echo(
            f"{row['sensing']:<8} {kind:<22} "
            f"{row['contacts']:>3}/{row['number']:<4} "
            f"{100 * low:>3.0f}-{100 * high:<3.0f} % "
            f"{row['falls']:>4} {row['closest_m']:>7.2f} m  {causes}"
        )
