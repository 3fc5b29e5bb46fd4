"""``stepaside robustness``: what a walk survives, on all cores."""

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from ..errors import OutputError
from ..outputs import check_folder
from .declared.body import BODY, CONTROL, FEEDBACK, METHOD, PHYSICS
from .declared.common import FOLDER, WORKERS, json_option
from .declared.gait import GAIT, PUSHES, WALK
from .declared.game import DURATION, RUN, SEED
from .declared.kinds import NameType
from .declared.take import SettingsCommand, takes_settings
from .options import print_json
from .robustness_tables import print_campaign, tell_stopped
from .terminal import echo

if TYPE_CHECKING:
    from ..games.walk import WalkSettings

OLD_KINDS = {"play": "backlash"}  # names of today by former ones


class Asked(NamedTuple):
    """What a campaign is asked for; see the options for each."""

    kinds: tuple[str, ...]
    methods: tuple[str, ...]
    body: str
    phases: int
    seeds: int
    seed: int
    changes: str = ""

    def settings(self) -> dict[str, Any]:
        """What a result says of it; changes only where there are any."""
        return {k: v for k, v in self._asdict().items() if v != ""}


def _kinds() -> Collection[str]:
    from ..studies.robustness import STRENGTHS

    return tuple(STRENGTHS)


def _methods() -> Collection[str]:
    from ..studies.robustness import METHODS

    return METHODS


def _walk() -> "type[WalkSettings]":
    from ..games.walk import WalkSettings

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
    help="Disturbance, any number of times; all by default. Of pushes the "
    "largest one survived is searched, to 0.1 N s for a robot of NAO's mass.",
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
    type=click.IntRange(1),
    default=8,
    show_default=True,
    help="Walks of each other disturbance.",
)
@WORKERS.option()
@FOLDER.option(
    help="Folder of results, which goes on with what it holds; "
    "runs/robustness-BODY by default, none with --json."
)
@json_option
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
    methods: tuple[str, ...],
    phases: int,
    seeds: int,
    workers: int | None,
    output: Path | None,
    as_json: bool,
) -> None:
    """Walk many times under one disturbance after the other.

    A campaign that was stopped writes no results; it goes on where it was
    when it is started again with the same folder. Of a configuration, which
    may be that of a duel, too, it takes all but duration, method and pushes.
    """
    from ..studies.changes import changes_of

    kinds = kinds or tuple(_kinds())
    body, changes = changes_of(settings)
    seed = settings.seed
    asked = Asked(
        *(_once(kinds), _once(methods), body, phases, seeds, seed), changes
    )
    if output is None and not as_json:
        output = Path("runs") / f"robustness-{body}"
    if output is not None:
        check_folder(output, new=False)
        output.mkdir(parents=True, exist_ok=True)
    grid, cases = _plan(asked)
    file = None if output is None else output / "trials.jsonl"
    results, stopped = _run(grid, cases, file, workers)
    answer = _answer(settings, body, grid, cases, results)
    failed: OutputError | None = None
    if output is not None and not stopped:
        try:
            _write(output, settings, asked, answer)
        except OutputError as error:
            failed = error
    if as_json:
        print_json(answer)
    else:
        print_campaign(answer)
    if stopped:
        tell_stopped(answer)
        raise SystemExit(130)
    if failed is not None:
        raise failed
    if not as_json:
        echo(f"\nresults: {output}")


def _once(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names))


def _plan(asked: Asked) -> tuple[list[Any], list[Any]]:
    """Trials of a grid, and pushes whose limit is to be searched."""
    from ..studies.limits import push_cases
    from ..studies.robustness import trials

    kinds, methods, body, phases, seeds, seed, changes = asked
    grid = trials(
        *(kinds, methods, body),
        seeds=seeds,
        first_seed=seed,
        changes=changes,
    )
    if "push" not in kinds:
        return list(grid), []
    cases = push_cases(
        methods, body, phases=phases, seed=seed, changes=changes
    )
    return list(grid), list(cases)


def _answer(
    settings: "WalkSettings",
    body: str,
    grid: list[Any],
    cases: list[Any],
    results: dict[str, bool],
) -> dict[str, Any]:
    """What was found so far, and how much that is of what is planned.

    How many walks the limits of the pushes take is not known before.
    """
    from ..studies.limits import outcomes_of
    from ..studies.robustness import mass_of, push_scale
    from ..studies.survival import (
        limit_rows,
        push_survival_rows,
        summarise_limits,
        survival_rows,
    )

    limits = limit_rows(cases, results)
    scale = push_scale(settings.robot)
    walks = sum(map(len, outcomes_of(cases, results).values()))
    return {
        "body": body,
        "robot": settings.robot,
        "mass_kg": mass_of(settings.robot),
        "planned": {"trials": len(grid), "push_limits": len(cases)},
        "done": {
            "trials": sum(trial.key in results for trial in grid),
            "push_limits": len(limits),
            "push_walks": walks,
        },
        "survival": survival_rows(grid, results)
        + push_survival_rows(limits, scale),
        "limits": limits,
        "limits_by_method": summarise_limits(limits),
    }


def _write(
    output: Path,
    settings: "WalkSettings",
    asked: Asked,
    answer: dict[str, Any],
) -> None:
    """Write the results of a whole campaign, each file at one stroke."""
    from ..report.robustness_figure import draw_limits, draw_survival
    from ..studies.pushes import pushes_result
    from ..studies.results import header, write_result
    from ..studies.robustness import UNITS
    from ..studies.trial_results import ROOMS

    head = header(asked.settings(), rooms=ROOMS)
    write_result(output / "survival.json", head, **answer)
    draw_survival(answer["survival"], UNITS, output / "survival.png")
    limits = answer["limits"]
    if limits:
        draw_limits(limits, output / "limits.png")
        made = pushes_result(
            *(limits, asked.methods, asked.body),
            phases=asked.phases,
            seed=asked.seed,
            walk=settings,
        )
        write_result(output / "pushes.json", made)


def _run(
    grid: list[Any], cases: list[Any], file: Path | None, workers: int | None
) -> tuple[dict[str, bool], bool]:
    """Run with a progress bar; whether Ctrl-C stopped it."""
    from tqdm import tqdm

    from ..studies.limits import search_limits
    from ..studies.robustness import run_campaign
    from ..studies.workers import worker_pool

    done: dict[str, bool] = {}
    with (
        tqdm(
            total=len(grid) + len(cases),
            desc="robustness",
            unit="job",
            disable=None,
        ) as bar,
        worker_pool(workers) as executor,
    ):

        def report(number: int) -> None:
            bar.n = number
            bar.refresh()

        try:
            run_campaign(grid, file, executor, report, done)
            search_limits(
                cases,
                file,
                executor,
                lambda number: report(len(grid) + number),
                done,
            )
        except KeyboardInterrupt:
            return done, True
    return done, False
