"""``stepaside robustness``: survival of a walk under disturbances."""

from collections.abc import Collection
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..games.duel_settings import SENSING
from ..games.walk_settings import WalkSettings
from ..sim.camera_settings import CameraSettings, depth_camera_of
from ..strategies.shield_settings import ShieldSettings
from .campaign_options import CampaignOptions, campaign_options
from .options.common_options import (
    figure_option,
    figure_width,
    json_option,
)
from .options.parameter_types import NameType
from .options.settings_options import (
    WALK,
    refuse_options,
    takes,
    takes_settings,
)
from .output_files import attempt, writes_files
from .plan import ENTRIES_OF_GAMES
from .robustness_people import (
    PeopleRequest,
    meet_people,
    print_people,
    write_people,
)
from .robustness_walks import (
    CampaignRequest,
    plan_walks,
    run_walks,
    summarise_walks,
    write_walks,
)
from .tables import interval, print_columns
from .terminal import echo, exit_interrupted, print_json, resume_message

if TYPE_CHECKING:
    from ..locomotion.policy.legs_settings import LegsSettings
    from ..studies.study import StudyRun


def progress_text(answer: dict[str, Any]) -> str:
    """Return how much of a campaign is finished."""
    done, planned = answer["done"], answer["planned"]
    return (
        f"{done['trials']} of {planned['trials']} trials and "
        f"{done['push_limits']} of {planned['push_limits']} push limits"
    )


def print_campaign(answer: dict[str, Any]) -> None:
    """Print survival rates, then push limits."""
    from ..studies.robustness_trial import UNITS

    print_columns(
        ("method", "disturbance", "strength", "survived", "95 %"),
        [
            (
                row["method"],
                f"{row['kind']} {row['direction']}".strip(),
                f"{row['strength']:g} {UNITS[row['kind']]}",
                f"{row['survived']}/{row['trials']}",
                interval(row["low"], row["high"], 0),
            )
            for row in answer["survival"]
        ],
        left=(0, 1),
    )
    if answer["limits"]:
        _print_limits(answer["limits"], answer["limits_by_method"])


def _print_limits(
    limits: list[dict[str, Any]], by_method: dict[str, Any]
) -> None:
    echo("\npush limit / bound of the pendulum [N s], by phase")
    for method in dict.fromkeys(r["method"] for r in limits):
        for direction in dict.fromkeys(r["direction"] for r in limits):
            cells = " ".join(
                f"{r['limit_n_s']:.1f}/{r['bound_n_s']:.1f}"
                for r in limits
                if (r["method"], r["direction"]) == (method, direction)
            )
            echo(f"{method:<12} {direction:<9} {cells}")
    echo(
        "\npush limit as a fraction of the pendulum's bound: median, minimum, "
        "maximum; cases above the bound"
    )
    for method, found in by_method.items():
        echo(
            f"{method:<12} {found['median_of_bound']:.2f} "
            f"{found['least_of_bound']:.2f} {found['most_of_bound']:.2f}  "
            f"{found['above_bound']} of {found['cases']}"
        )


PERSON = "person"
OF_CAMERAS = {"--depth-camera": "depth", "--rear-camera": "rear_camera"}
OF_SHIELD = {
    "--shield": "enabled",
    **{
        f"--shield-{name.replace('_', '-')}": name
        for name in (
            *("speed", "turning_radius", "contact", "sighting_error"),
            *("sighting_delay", "loss", "response"),
        )
    },
}


def _kinds() -> Collection[str]:
    from ..studies.robustness_trial import KINDS

    return KINDS


def _reactions() -> Collection[str]:
    from ..studies.person_encounters import LADDER

    return LADDER


def _methods() -> Collection[str]:
    from ..studies.robustness_trial import METHODS

    return METHODS


@click.command("robustness")
@click.option(
    "--kind",
    "kinds",
    type=NameType(_kinds),
    multiple=True,
    help="Disturbance; repeatable. All except person by default. For pushes, "
    "search the largest impulse survived, to 0.1 N s for NAO (scaled by "
    "push_unit for other robots). For person, let people approach the "
    "standing robot from all directions.",
)
@click.option(
    "--sensing",
    "sensings",
    type=NameType(lambda: SENSING),
    multiple=True,
    default=("ideal",),
    help="Sensing of people, with --kind person; repeatable.  "
    "[default: ideal]",
)
@click.option(
    "--method",
    "methods",
    type=NameType(_methods),
    multiple=True,
    default=("open-loop", "measured"),
    help="Control method; repeatable.  [default: open-loop, measured]",
)
@click.option(
    "--phases",
    type=click.IntRange(1, 64),
    default=8,
    show_default=True,
    help="Number of phases of the gait cycle at which pushes are applied.",
)
@click.option(
    "--seeds",
    type=click.IntRange(1, 1_000),
    default=8,
    show_default=True,
    help="Number of walks for each disturbance other than pushes.",
)
@click.option(
    "--legs",
    default="",
    help="ONNX file of a walking policy, with --kind person; by default that "
    "of the robot's description.",
)
@click.option(
    "--strategy",
    default="",
    metavar="NAME",
    help="Strategy of the robot, with --kind person; by default evasion by "
    "time to contact, or step-aside on learned legs.",
)
@click.option(
    "--reaction",
    "reactions",
    type=NameType(_reactions),
    multiple=True,
    help="What people do near the robot, with --kind person; repeatable. All "
    "by default.",
)
@click.option(
    "--people",
    type=click.IntRange(0, 10_000_000),
    default=0,
    help="Number of people drawn at random, with --kind person, instead of a "
    "grid: from all sides, up to 1.4 m/s, with all reactions, every second "
    "one found hard by a search in the template.",
)
@campaign_options(
    "Folder of results; an interrupted campaign in it is continued. "
    "runs/robustness-BODY by default, none with --json."
)
@figure_option(
    help="Write a copy of the survival figure (.png, .svg or .pdf)."
)
@figure_width
@json_option
@writes_files
@takes(ShieldSettings, "shield", OF_SHIELD)
@takes(CameraSettings, "cameras", OF_CAMERAS)
@takes_settings(
    WalkSettings,
    WALK,
    without=("duration", "pushes", "control.method", "control.feedback"),
    ignored=ENTRIES_OF_GAMES,
    meanings={
        "seed": "Random seed of the first walk; later walks increment it. "
        "Pushes use this seed only"
    },
)
def robustness(
    settings: WalkSettings,
    kinds: tuple[str, ...],
    sensings: tuple[str, ...],
    methods: tuple[str, ...],
    phases: int,
    seeds: int,
    legs: str,
    strategy: str,
    reactions: tuple[str, ...],
    people: int,
    shield: ShieldSettings,
    cameras: CameraSettings,
    campaign: CampaignOptions,
    figure: str | None,
    as_json: bool,
) -> None:
    """Measure how many simulated walks survive each disturbance.

    To continue an interrupted campaign, run it again with the same folder.
    A configuration of a walk or a duel may be given; its duration, method
    and pushes are ignored.
    """
    from ..studies.settings_diff import changes_of

    kinds = _unique(kinds) or tuple(k for k in _kinds() if k != PERSON)
    if PERSON not in kinds:
        refuse_options(
            {
                "sensings",
                "legs",
                "strategy",
                "reactions",
                "people",
                "depth",
                "rear_camera",
            },
            f"--kind {PERSON}",
        )
    if people:
        refuse_options({"reactions"}, "no --people")
        if len(_unique(sensings)) > 1:
            raise click.UsageError("--people takes one --sensing")
    if "cameras" not in sensings:
        refuse_options({"depth", "rear_camera"}, "--sensing cameras")
    if "push" not in kinds:
        refuse_options({"phases"}, "--kind push")
    body, changes = changes_of(settings)
    if not as_json:
        campaign = campaign.with_default(Path("runs") / f"robustness-{body}")
    output = campaign.output
    request = CampaignRequest(
        kinds=tuple(kind for kind in kinds if kind != PERSON),
        methods=_unique(methods),
        body=body,
        phases=phases,
        seeds=seeds,
        seed=settings.seed,
        changes=changes,
    )
    answer: dict[str, Any] = {}
    last: StudyRun[Any] | None = None
    if request.kinds:
        walks = run_walks(*plan_walks(request), campaign)
        answer, last = summarise_walks(settings, body, walks), walks.last
        if output is not None and last.completed and campaign.is_whole:
            folder = output
            attempt(lambda: write_walks(folder, settings, request, answer))
    if PERSON in kinds and (last is None or last.completed):
        policy = _legs_of(settings.robot, legs)
        met = PeopleRequest(
            _unique(sensings),
            seeds,
            policy,
            strategy,
            _unique(reactions),
            people,
            shield,
            cameras,
        )
        asked = _description_of(met, body, settings.seed, changes)
        found, last = meet_people(settings, met, campaign)
        answer["person"] = found
        if output is not None and last.completed and campaign.is_whole:
            folder = output
            attempt(lambda: write_people(folder, asked, found))
    assert last is not None
    if figure is not None and last.completed and "survival" in answer:
        _draw(answer, Path(figure))
    _print_all(answer, output, stopped=last.interrupted, as_json=as_json)
    if last.failure is not None:
        raise last.failure
    if not as_json:
        echo(f"\nresults: {output}")


def _draw(answer: dict[str, Any], file: Path) -> None:
    """Draw the survival of walks."""
    from ..report.robustness_figure import draw_survival
    from ..studies.robustness_trial import UNITS

    attempt(lambda: draw_survival(answer["survival"], UNITS, file))


def _description_of(
    met: "PeopleRequest", body: str, seed: int, changes: str
) -> dict[str, Any]:
    """Return a request as it stands in its results, without defaults."""
    network = Path(met.legs.network).name if met.legs.walks else ""
    shield = asdict(met.shield) if met.shield.enabled else {}
    chosen = {
        "legs": network,
        "strategy": met.strategy,
        "shield": shield,
        "reactions": met.reactions,
        "people": met.number,
        "depth_camera": depth_camera_of(met.cameras),
        "rear_camera": met.cameras.rear_camera,
        "changes": changes,
    }
    return {
        "kind": PERSON,
        "sensings": met.sensings,
        "body": body,
        "seeds": met.seeds,
        "seed": seed,
        **{name: value for name, value in chosen.items() if value},
    }


def _print_all(
    answer: dict[str, Any],
    output: Path | None,
    *,
    stopped: bool,
    as_json: bool,
) -> None:
    """Print all results; exit with the status of its signal after Ctrl-C."""
    people = answer.get(PERSON)
    if as_json:
        print_json(answer)
    else:
        if "survival" in answer:
            print_campaign(answer)
        if people is not None:
            print_people(people)
    if not stopped:
        return
    done = (
        progress_text(answer)
        if people is None
        else f"{people['done']} of {people['planned']} encounters"
    )
    exit_interrupted(resume_message(done, output))


def _legs_of(robot: str, network: str) -> "LegsSettings":
    """Return the walking policy of a robot, if it has one.

    Args:
        robot: Name of the robot, or folder of its description.
        network: Network that is used instead; empty for that of the robot.
    """
    from ..games.robot_settings import settings_of_robot
    from ..locomotion.policy.legs_settings import LegsSettings

    return LegsSettings(network) if network else settings_of_robot(robot).legs


def _unique(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names))
