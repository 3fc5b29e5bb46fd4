"""``stepaside robustness``: what a walk survives, on all cores."""

import json
import os
from pathlib import Path
from typing import Any

import click

from .options import json_option, print_json

KINDS = ("push", "friction", "unevenness", "delay", "play", "noise", "model")
METHODS = ("open-loop", "closed-form", "measured", "mpc")


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
    "--seed", type=click.IntRange(0), default=1, help="The first one."
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

    A campaign that was stopped goes on where it was when it is started
    again with the same folder.
    """
    from ..studies.limits import push_cases
    from ..studies.pushes import pushes_result
    from ..studies.robustness import UNITS, trials
    from ..studies.survival import (
        limit_rows,
        push_survival_rows,
        summarise_limits,
        survival_rows,
    )

    kinds, methods = kinds or KINDS, methods or ("open-loop", "measured")
    grid = list(trials(kinds, methods, body, seeds=seeds, first_seed=seed))
    cases = []
    if "push" in kinds:
        cases = list(push_cases(methods, body, phases=phases, seed=seed))
    if output is None and not as_json:
        output = Path("runs") / f"robustness-{body}"
    if output is not None:
        output.mkdir(parents=True, exist_ok=True)
    file = None if output is None else output / "trials.jsonl"
    results, stopped = _run(grid, cases, file, workers)
    limits = limit_rows(cases, results)
    rows = survival_rows(grid, results) + push_survival_rows(limits)
    answer: dict[str, Any] = {
        "body": body,
        "trials": len(results),
        "planned": len(grid),
        "push_cases": len(cases),
        "survival": rows,
        "limits": limits,
        "limits_by_method": summarise_limits(limits),
    }
    if output is not None and rows:
        from ..report.robustness_figure import draw_limits, draw_survival

        (output / "survival.json").write_text(
            json.dumps(answer, indent=1), encoding="utf-8"
        )
        draw_survival(rows, UNITS, output / "survival.png")
        if limits:
            draw_limits(limits, output / "limits.png")
            made = pushes_result(
                limits, methods, body, phases=phases, seed=seed
            )
            (output / "pushes.json").write_text(
                json.dumps(made, indent=1) + "\n", encoding="utf-8"
            )
    if as_json:
        print_json(answer)
    else:
        _print(rows, limits, UNITS)
        click.echo(f"\nresults: {output}")
    if stopped:
        raise SystemExit(130)


def _run(
    grid: list[Any], cases: list[Any], file: Path | None, workers: int | None
) -> tuple[dict[str, bool], bool]:
    """Run with a progress bar; whether Ctrl-C stopped it."""
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    from tqdm import tqdm

    from ..studies.limits import search_limits
    from ..studies.robustness import run_campaign

    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    done: dict[str, bool] = {}
    with (
        tqdm(
            total=len(grid) + len(cases),
            desc="robustness",
            unit="job",
            disable=None,
        ) as bar,
        ProcessPoolExecutor(workers, get_context("spawn")) as executor,
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


def _print(
    rows: list[dict[str, Any]],
    limits: list[dict[str, Any]],
    units: dict[str, str],
) -> None:
    head = ("method", "disturbance", "strength", "survived", "95 %")
    click.echo("{:<12} {:<16} {:>10} {:>9}  {}".format(*head))
    for row in rows:
        kind = f"{row['kind']} {row['direction']}".strip()
        click.echo(
            f"{row['method']:<12} {kind:<16} {row['strength']:>10g} "
            f"{row['survived']:>4}/{row['trials']:<4}  "
            f"{100 * row['low']:.0f}-{100 * row['high']:.0f} %"
            f"   [{units[row['kind']]}]"
        )
    if not limits:
        return
    from ..studies.survival import summarise_limits

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
    for method, found in summarise_limits(limits).items():
        click.echo(
            f"{method:<12} {found['median_of_bound']:.2f} "
            f"{found['least_of_bound']:.2f} {found['most_of_bound']:.2f}  "
            f"{found['above_bound']} of {found['cases']}"
        )
