"""``stepaside reproduce``: measurement of every claim of the paper."""

import json
from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import atomic_draft, check_folder
from ..core.errors import OutputError
from .campaign_reports import report_set_aside
from .effort_estimate import announce_effort
from .interruption import exit_interrupted, resume_message
from .options.common_options import (
    folder_option,
    json_option,
    seed_option,
    workers_option,
)
from .progress import show_progress
from .terminal import echo, print_json


@click.command("reproduce")
@seed_option(
    default=1,
    show_default=True,
    help="Random seed of the first run; later runs increment it.",
)
@click.option(
    "--runs",
    type=click.IntRange(1, 1_000),
    default=10,
    show_default=True,
    help="Number of runs of each claim that is measured in physics.",
)
@workers_option()
@folder_option(
    default=Path("runs/reproduce"),
    show_default=True,
    help="Folder of the report. Measurements in it are reused if code, "
    "settings and libraries are the same.",
)
@json_option
def reproduce(
    seed: int, runs: int, workers: int | None, output: Path, as_json: bool
) -> None:
    """Measure every claim of the paper and write a report.

    Takes a few minutes. Finished measurements are saved, so that an
    interrupted reproduction can be continued with the same command. The exit
    status is 1 if a claim fails.
    """
    check_folder(output, new=False)
    announce_effort(
        f"every claim of the paper, {runs} runs of those in physics",
        60.0 + 120.0 * runs,
        workers,
    )
    lost: list[OutputError] = []
    seeds = range(seed, seed + runs)
    rows = _measure(output / "rows", seeds, workers, lost)
    page: Path | None = None
    try:
        if not lost:
            page = _write_all(output, seed, runs, rows)
    except KeyboardInterrupt:
        done = "all runs and completed figures"
        exit_interrupted(resume_message(done, output))
    except OutputError as error:
        lost.append(error)
    _tell(rows, page, as_json)
    for failed in lost:
        raise failed
    if any(row["verdict"] != "holds" for row in rows):
        raise SystemExit(1)


def _write_all(
    output: Path, seed: int, runs: int, rows: list[dict[str, Any]]
) -> Path:
    """Write figures, results and the report."""
    from ..report.claims_page import write_page
    from ..studies.claim_campaign import provenance
    from ..studies.paper_figures import paper_figures
    from .reproduce_figures import draw_figures, turns_shown

    figures = draw_figures(output, seed)
    made = {"seed": seed, "runs": runs, "jobs": provenance(seed)}
    with atomic_draft(output / "claims.json") as draft:
        text = json.dumps(made | {"rows": rows}, indent=1, allow_nan=False)
        draft.write_text(text + "\n", encoding="utf-8")
    beside = paper_figures(rows, *turns_shown())
    return write_page(output, rows, beside, figures, made)


def _tell(
    rows: list[dict[str, Any]], page: Path | None, as_json: bool
) -> None:
    """Print all verdicts and the path of the report."""
    if as_json:
        print_json(rows)
        return
    for row in rows:
        echo(f"  {row['verdict']:<6} {row['section']:<13} {row['claim']}")
    held = sum(row["verdict"] == "holds" for row in rows)
    echo(f"\n{held} of {len(rows)} hold")
    if page is not None:
        echo(f"page: {page}")


def _measure(
    folder: Path,
    seeds: range,
    workers: int | None,
    lost: list[OutputError],
) -> list[dict[str, Any]]:
    """Measure on all cores, with a progress bar.

    Even a single worker is a separate process: a duel that Ctrl-C interrupts
    in this process would be stored as if it were complete.
    """
    from ..core.worker_pool import worker_pool
    from ..studies.claim_campaign import reproduce as measure

    with (
        show_progress("claims", unit="runs") as bar,
        worker_pool(workers) as executor,
    ):

        def report(number: int, total: int) -> None:
            bar.total, bar.n = total, number
            bar.refresh()

        try:
            return measure(
                folder, seeds, executor, report, report_set_aside, lost.append
            )
        except KeyboardInterrupt:
            exit_interrupted(
                resume_message(f"{bar.n} of {bar.total} runs", folder)
            )
