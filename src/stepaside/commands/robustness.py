"""``stepaside robustness``: what a walk survives, on all cores."""

from pathlib import Path
from typing import Any, NamedTuple

import click

from .options import json_option, print_json

KINDS = (
    "push",
    "friction",
    "unevenness",
    "delay",
    "backlash",
    "noise",
    "model",
)
METHODS = ("open-loop", "closed-form", "measured", "mpc")


class Asked(NamedTuple):
    """What a campaign is asked for; see the options for each."""

    kinds: tuple[str, ...]
    methods: tuple[str, ...]
    body: str
    phases: int
    seeds: int
    seed: int


@click.command("robustness")
@click.option(
    "--kind",
    "kinds",
    type=click.Choice(KINDS),
    multiple=True,
    help="Disturbance, any number of times; all by default. Of pushes the "
    "largest one survived is searched, to 0.1 N s.",
)
@click.option(
    "--method",
    "methods",
    type=click.Choice(METHODS),
    multiple=True,
    help="How the walk is controlled, any number of times; open-loop and "
    "measured by default.",
)
@click.option(
    "--body",
    type=click.Choice(["ideal", "delayed", "hardware"]),
    default="ideal",
    show_default=True,
    help="How far the body is from an ideal one.",
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
@click.option(
    "--seed",
    type=click.IntRange(0),
    default=1,
    show_default=True,
    help="Of the first walk; the others follow it. Pushes have only this one.",
)
@click.option(
    "--workers", type=click.IntRange(1), help="Processes; all cores."
)
@click.option(
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder of results, which goes on with what it holds; "
    "runs/robustness-BODY by default, none with --json.",
)
@json_option
def robustness(
    kinds: tuple[str, ...],
    methods: tuple[str, ...],
    body: str,
    phases: int,
    seeds: int,
    seed: int,
    workers: int | None,
    output: Path | None,
    as_json: bool,
) -> None:
    """Walk many times under one disturbance after the other.

    A campaign that was stopped writes no results; it goes on where it was
    when it is started again with the same folder.
    """
    kinds, methods = kinds or KINDS, methods or ("open-loop", "measured")
    asked = Asked(_once(kinds), _once(methods), body, phases, seeds, seed)
    if output is None and not as_json:
        output = Path("runs") / f"robustness-{body}"
    if output is not None:
        output.mkdir(parents=True, exist_ok=True)
    grid, cases = _plan(asked)
    file = None if output is None else output / "trials.jsonl"
    results, stopped = _run(grid, cases, file, workers)
    answer = _answer(body, grid, cases, results)
    if output is not None and not stopped:
        _write(output, asked, answer)
    if as_json:
        print_json(answer)
    else:
        _print(answer)
    if stopped:
        _tell_stopped(answer)
        raise SystemExit(130)
    if not as_json:
        click.echo(f"\nresults: {output}")


def _once(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names))


def _plan(asked: Asked) -> tuple[list[Any], list[Any]]:
    """Trials of a grid, and pushes whose limit is to be searched."""
    from ..studies.limits import push_cases
    from ..studies.robustness import trials

    kinds, methods, body, phases, seeds, seed = asked
    grid = trials(kinds, methods, body, seeds=seeds, first_seed=seed)
    if "push" not in kinds:
        return list(grid), []
    cases = push_cases(methods, body, phases=phases, seed=seed)
    return list(grid), list(cases)


def _answer(
    body: str, grid: list[Any], cases: list[Any], results: dict[str, bool]
) -> dict[str, Any]:
    """What was found so far, and how much that is of what is planned.

    How many walks the limits of the pushes take is not known before.
    """
    from ..studies.limits import outcomes_of
    from ..studies.survival import (
        limit_rows,
        push_survival_rows,
        summarise_limits,
        survival_rows,
    )

    limits = limit_rows(cases, results)
    walks = sum(map(len, outcomes_of(cases, results).values()))
    return {
        "body": body,
        "planned": {"trials": len(grid), "push_limits": len(cases)},
        "done": {
            "trials": sum(trial.key in results for trial in grid),
            "push_limits": len(limits),
            "push_walks": walks,
        },
        "survival": survival_rows(grid, results) + push_survival_rows(limits),
        "limits": limits,
        "limits_by_method": summarise_limits(limits),
    }


def _write(output: Path, asked: Asked, answer: dict[str, Any]) -> None:
    """Write the results of a whole campaign, each file at one stroke."""
    from ..report.robustness_figure import draw_limits, draw_survival
    from ..studies.pushes import pushes_result
    from ..studies.results import header, write_result
    from ..studies.robustness import UNITS
    from ..studies.trial_results import ROOMS

    head = header(asked._asdict(), rooms=ROOMS)
    write_result(output / "survival.json", head, **answer)
    draw_survival(answer["survival"], UNITS, output / "survival.png")
    limits = answer["limits"]
    if limits:
        draw_limits(limits, output / "limits.png")
        _, methods, body, phases, _, seed = asked
        made = pushes_result(limits, methods, body, phases=phases, seed=seed)
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


def _tell_stopped(answer: dict[str, Any]) -> None:
    done, planned = answer["done"], answer["planned"]
    click.echo(
        f"stopped after {done['trials']} of {planned['trials']} trials, "
        f"{done['push_limits']} of {planned['push_limits']} limits of pushes",
        err=True,
    )


def _print(answer: dict[str, Any]) -> None:
    """Print survival, then the largest pushes."""
    from ..studies.robustness import UNITS

    head = ("method", "disturbance", "strength", "survived", "95 %")
    click.echo("{:<12} {:<16} {:>10} {:>9}  {}".format(*head))
    for row in answer["survival"]:
        kind = f"{row['kind']} {row['direction']}".strip()
        click.echo(
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
    click.echo("\nlargest push survived / pendulum's bound [N s], by phase")
    for method in dict.fromkeys(r["method"] for r in limits):
        for direction in dict.fromkeys(r["direction"] for r in limits):
            cells = " ".join(
                f"{r['limit_n_s']:.1f}/{r['bound_n_s']:.1f}"
                for r in limits
                if (r["method"], r["direction"]) == (method, direction)
            )
            click.echo(f"{method:<12} {direction:<9} {cells}")
    click.echo("\nmeasured over the bound: median, least, most; above it")
    for method, found in by_method.items():
        click.echo(
            f"{method:<12} {found['median_of_bound']:.2f} "
            f"{found['least_of_bound']:.2f} {found['most_of_bound']:.2f}  "
            f"{found['above_bound']} of {found['cases']}"
        )
