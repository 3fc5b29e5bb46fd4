"""``stepaside robustness``: what a walk survives, on all cores."""

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import check_folder
from ..core.errors import OutputError
from .campaign_reports import CampaignOutcome
from .interruption import kept_in, leave_stopped
from .options.body_options import BODY, CONTROL, FEEDBACK, METHOD, PHYSICS
from .options.common_options import (
    FIGURE,
    FOLDER,
    WORKERS,
    figure_width,
    json_option,
)
from .options.gait_options import GAIT, WALK
from .options.game_options import DURATION, RUN, SEED
from .options.push_type import PUSHES
from .options.settings_command import SettingsCommand, takes_settings
from .options.value_kinds import NameType
from .output_files import attempt, writes_files
from .robustness_people import meet_people, print_people, write_people
from .robustness_walks import (
    CampaignRequest,
    answer_walks,
    plan_walks,
    run_walks,
    write_walks,
)
from .terminal import echo
from .value_types import print_json

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings


def words_of_done(answer: dict[str, Any]) -> str:
    """How far a campaign came."""
    done, planned = answer["done"], answer["planned"]
    return (
        f"{done['trials']} of {planned['trials']} trials and "
        f"{done['push_limits']} of {planned['push_limits']} limits of pushes"
    )


def print_campaign(answer: dict[str, Any]) -> None:
    """Print survival, then the largest pushes."""
    from ..studies.robustness_campaign import UNITS

    head = ("method", "disturbance", "strength", "survived", "95 %")
    echo("{:<12} {:<16} {:>10} {:>9}  {}".format(*head))
    for row in answer["survival"]:
        kind = f"{row['kind']} {row['direction']}".strip()
        echo(
            f"{row['method']:<12} {kind:<16} {row['strength']:>10g} "
            f"{row['survived']:>4}/{row['trials']:<4}  "
            f"{100 * row['low']:.0f}-{100 * row['high']:.0f} %"
            f"   [{UNITS[row['kind']]}]"
        )
    if answer["limits"]:
        _print_limits(answer["limits"], answer["limits_by_method"])


def _print_limits(
    limits: list[dict[str, Any]], by_method: dict[str, Any]
) -> None:
    echo("\nlargest push survived / pendulum's bound [N s], by phase")
    for method in dict.fromkeys(r["method"] for r in limits):
        for direction in dict.fromkeys(r["direction"] for r in limits):
            cells = " ".join(
                f"{r['limit_n_s']:.1f}/{r['bound_n_s']:.1f}"
                for r in limits
                if (r["method"], r["direction"]) == (method, direction)
            )
            echo(f"{method:<12} {direction:<9} {cells}")
    echo("\nmeasured over the pendulum's bound: median, least, most; above it")
    for method, found in by_method.items():
        echo(
            f"{method:<12} {found['median_of_bound']:.2f} "
            f"{found['least_of_bound']:.2f} {found['most_of_bound']:.2f}  "
            f"{found['above_bound']} of {found['cases']}"
        )


PERSON = "person"
OLD_KINDS = {"play": "backlash"}  # names of today by former ones


def _kinds() -> Collection[str]:
    from ..studies.robustness_campaign import KINDS

    return KINDS


def _senses() -> Collection[str]:
    from ..games.duel_settings import SENSING

    return SENSING


def _methods() -> Collection[str]:
    from ..studies.robustness_campaign import METHODS

    return METHODS


def _walk() -> "type[WalkSettings]":
    from ..games.walk_settings import WalkSettings

    return WalkSettings


def _others() -> Collection[str]:
    from .plan_settings import entries_of_others

    return entries_of_others()


@click.command("robustness", cls=SettingsCommand)
@click.option(
    "--kind",
    "kinds",
    type=NameType(_kinds, OLD_KINDS),
    multiple=True,
    help="Disturbance, any number of times; all but persons by default. Of "
    "pushes the largest one survived is searched, to 0.1 N s for NAO, and "
    "push_unit times that for others. Persons come from all around at one "
    "who stands.",
)
@click.option(
    "--sensing",
    "sensings",
    type=NameType(_senses),
    multiple=True,
    default=("ideal",),
    help="How persons are seen, any number of times; ideal by default.",
)
@click.option(
    "--method",
    "methods",
    type=NameType(_methods),
    multiple=True,
    default=("open-loop", "measured"),
    help="How the walk is controlled, any number of times; open-loop and "
    "measured by default.",
)
@click.option(
    "--phases",
    type=click.IntRange(1, 64),
    default=8,
    show_default=True,
    help="Phases of the gait cycle at which each push is tried.",
)
@click.option(
    "--seeds",
    type=click.IntRange(1, 1_000),
    default=8,
    show_default=True,
    help="Walks of each other disturbance.",
)
@WORKERS.option()
@FOLDER.option(
    help="Folder of results, which goes on with what it holds; "
    "runs/robustness-BODY by default, none with --json."
)
@FIGURE.option(help="Write survival here, too (.png, .svg or .pdf).")
@figure_width
@json_option
@writes_files
@takes_settings(
    _walk,
    RUN.without(DURATION),
    WALK.without(PUSHES),
    GAIT,
    BODY,
    CONTROL.without(METHOD, FEEDBACK),
    PHYSICS,
    aside=_others,
    meanings={
        SEED: "Of the first walk; the others follow it. Pushes have only "
        "this one."
    },
)
def robustness(
    settings: "WalkSettings",
    kinds: tuple[str, ...],
    sensings: tuple[str, ...],
    methods: tuple[str, ...],
    phases: int,
    seeds: int,
    workers: int | None,
    output: Path | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Walk many times under one disturbance after the other.

    A campaign that was stopped writes no results; it goes on where it was
    when it is started again with the same folder. Of a configuration, which
    may be that of a duel, too, it takes all but duration, method and pushes.
    """
    from ..studies.settings_diff import changes_of

    kinds = _once(kinds) or tuple(k for k in _kinds() if k != PERSON)
    body, changes = changes_of(settings)
    if output is None and not as_json:
        output = Path("runs") / f"robustness-{body}"
    if output is not None:
        check_folder(output, new=False)
    asked = CampaignRequest(
        tuple(kind for kind in kinds if kind != PERSON),
        *(_once(methods), body, phases, seeds, settings.seed, changes),
    )
    answer, ended = _walk_on(settings, asked, output, workers)
    if PERSON in kinds and ended.whole:
        people = {
            "kind": PERSON,
            "sensings": _once(sensings),
            "body": body,
            "seeds": seeds,
            "seed": settings.seed,
            **({"changes": changes} if changes else {}),
        }
        file = None if output is None else output / "encounters.jsonl"
        found, ended = meet_people(
            settings, _once(sensings), seeds, file, workers
        )
        answer["person"] = found
        if output is not None and ended.whole:
            try:
                write_people(output, people, found)
            except OutputError as error:
                ended = CampaignOutcome(failed=error)
    if figure is not None and not ended.stopped and "survival" in answer:
        from ..report.robustness_figure import draw_survival
        from ..studies.robustness_campaign import UNITS

        attempt(lambda: draw_survival(answer["survival"], UNITS, Path(figure)))
    _tell(answer, output, stopped=ended.stopped, as_json=as_json)
    if ended.failed is not None:
        raise ended.failed
    if not as_json:
        echo(f"\nresults: {output}")


def _walk_on(
    settings: "WalkSettings",
    asked: CampaignRequest,
    output: Path | None,
    workers: int | None,
) -> tuple[dict[str, Any], CampaignOutcome]:
    """Walk under disturbances, if any are asked for.

    Returns:
        What was found, and how it ended, or what went wrong when it was
        written.
    """
    if not asked.kinds:
        return {}, CampaignOutcome()
    grid, cases = plan_walks(asked)
    file = None if output is None else output / "trials.jsonl"
    results, ended = run_walks(grid, cases, file, workers)
    answer = answer_walks(settings, asked.body, grid, cases, results)
    if output is not None and ended.whole:
        try:
            write_walks(output, settings, asked, answer)
        except OutputError as error:
            return answer, CampaignOutcome(failed=error)
    return answer, ended


def _tell(
    answer: dict[str, Any],
    output: Path | None,
    *,
    stopped: bool,
    as_json: bool,
) -> None:
    """Print what was found; leave with 130 after a Ctrl-C."""
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
        words_of_done(answer)
        if people is None
        else f"{people['done']} of {people['planned']} persons"
    )
    leave_stopped(kept_in(done, output))


def _once(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names))
