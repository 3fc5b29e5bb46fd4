"""``stepaside robustness --kind person``: encounters with people."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..sim.camera_settings import CameraSettings
from ..strategies.shield_settings import ShieldSettings
from .campaign_options import CampaignOptions
from .campaign_reports import run_campaign
from .tables import interval, number, print_columns
from .terminal import echo

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings
    from ..locomotion.policy.legs_settings import LegsSettings
    from ..studies.study import StudyRun


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
        cameras: Its cameras.
    """

    sensings: tuple[str, ...]
    seeds: int
    legs: "LegsSettings"
    strategy: str = ""
    reactions: tuple[str, ...] = ()
    number: int = 0
    shield: ShieldSettings = ShieldSettings()
    cameras: CameraSettings = CameraSettings()


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
        settings,
        request.legs,
        request.strategy,
        request.shield,
        request.cameras,
    )
    if request.number:
        base = replace(base, seed=settings.seed)
        (sensing,) = request.sensings
        drawn = run_campaign(
            drawn_study(base, sensing, request.number), campaign, "games"
        )
        return {
            "planned": drawn.total,
            "done": drawn.finished,
            "reactions": reaction_rows(drawn.items()),
        }, drawn
    grid = encounters(
        base,
        request.sensings,
        range(settings.seed, settings.seed + request.seeds),
        reactions=request.reactions or LADDER,
    )
    run = run_campaign(people_study(list(grid)), campaign, "games")
    found = list(run.items())
    return {
        "planned": run.total,
        "done": run.finished,
        "clearance_m": base.strategy.clearance,
        "people": people_rows(found),
        "passing": passing_rows(found),
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
        print_columns(
            ("sensing", "speed", "contacts", "closest", "template", "theory"),
            [
                (
                    row["sensing"],
                    f"{row['speed_m_s']:g} m/s",
                    f"{row['contacts']}/{row['number']}",
                    *(
                        number(row[name], "m", 2)
                        for name in (
                            *("closest_m", "template_closest_m"),
                            "theory_room_m",
                        )
                    ),
                )
                for row in answer["people"]
            ],
        )
    for row in answer.get("passing", ()):
        echo(
            f"{row['sensing']}: {row['false_triggers']} false triggers with "
            f"{row['number']} passing pedestrians, "
            f"{row['false_triggers_per_hour']:.1f} per hour"
        )
    echo()
    heads = ("sensing", "reaction", "contacts", "95 %", "falls", "closest")
    print_columns(
        (*heads, "causes"),
        [_reaction_cells(row) for row in answer["reactions"]],
        left=(0, 1, 6),
    )


def _reaction_cells(row: dict[str, Any]) -> tuple[str, ...]:
    """Return the cells of the encounters with one reaction."""
    return (
        row["sensing"],
        row["reaction"] + (" (searched)" if row["hard"] else ""),
        f"{row['contacts']}/{row['number']}",
        interval(row["contacts_low"], row["contacts_high"], 0),
        str(row["falls"]),
        number(row["closest_m"], "m", 2),
        ", ".join(f"{n} {c}" for c, n in row["causes"].items()),
    )
