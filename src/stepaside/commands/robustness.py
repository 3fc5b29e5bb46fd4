"""``stepaside robustness``: what a walk survives, on all cores."""

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import OutputError
from ..outputs import check_folder
from .campaigns import Ended
from .declared.body import BODY, CONTROL, FEEDBACK, METHOD, PHYSICS
from .declared.common import (
    FIGURE,
    FOLDER,
    WORKERS,
    figure_width,
    json_option,
)
from .declared.gait import GAIT, WALK
from .declared.game import DURATION, RUN, SEED
from .declared.kinds import NameType
from .declared.push import PUSHES
from .declared.take import SettingsCommand, takes_settings
from .options import print_json
from .outputs import attempt, writes_files
from .robustness_people import meet_people, print_people, write_people
from .robustness_tables import print_campaign, words_of_done
from .robustness_walks import (
    Asked,
    answer_walks,
    plan_walks,
    run_walks,
    write_walks,
)
from .stopping import kept_in, leave_stopped
from .terminal import echo

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings

PERSON = "person"
OLD_KINDS = {"play": "backlash"}  # names of today by former ones


def _kinds() -> Collection[str]:
    from ..studies.robustness import KINDS

    return KINDS


def _senses() -> Collection[str]:
    from ..games.settings import SENSING

    return SENSING


def _methods() -> Collection[str]:
    from ..studies.robustness import METHODS

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
    from ..studies.changes import changes_of

    kinds = _once(kinds) or tuple(k for k in _kinds() if k != PERSON)
    body, changes = changes_of(settings)
    if output is None and not as_json:
        output = Path("runs") / f"robustness-{body}"
    if output is not None:
        check_folder(output, new=False)
    asked = Asked(
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
                ended = Ended(failed=error)
    if figure is not None and not ended.stopped and "survival" in answer:
        from ..report.robustness_figure import draw_survival
        from ..studies.robustness import UNITS

        attempt(lambda: draw_survival(answer["survival"], UNITS, Path(figure)))
    _tell(answer, output, stopped=ended.stopped, as_json=as_json)
    if ended.failed is not None:
        raise ended.failed
    if not as_json:
        echo(f"\nresults: {output}")


def _walk_on(
    settings: "WalkSettings",
    asked: Asked,
    output: Path | None,
    workers: int | None,
) -> tuple[dict[str, Any], Ended]:
    """Walk under disturbances, if any are asked for.

    Returns:
        What was found, and how it ended, or what went wrong when it was
        written.
    """
    if not asked.kinds:
        return {}, Ended()
    grid, cases = plan_walks(asked)
    file = None if output is None else output / "trials.jsonl"
    results, ended = run_walks(grid, cases, file, workers)
    answer = answer_walks(settings, asked.body, grid, cases, results)
    if output is not None and ended.whole:
        try:
            write_walks(output, settings, asked, answer)
        except OutputError as error:
            return answer, Ended(failed=error)
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
