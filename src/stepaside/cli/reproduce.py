"""``stepaside reproduce``: measurement of every claim of the paper."""

import json
from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import atomic_draft, check_folder
from ..core.errors import OutputError
from .campaign_options import (
    CampaignOptions,
    campaign_options,
    finish_campaign,
    run_campaign,
)
from .options.common_options import (
    json_option,
    seed_option,
)
from .progress import announce_effort
from .terminal import echo, exit_interrupted, print_json, resume_message

RECORDS = "claims.sqlite"
SKIPPED = (
    "  skipped the paper's game on learned legs: --legs-robot names a robot "
    "with a walking policy"
)


@click.command("reproduce")
@seed_option(
    default=1,
    show_default=True,
    help="Random seed of the first run; later runs increment it.",
)
@click.option(
    "--runs",
    type=click.IntRange(0, 1_000),
    default=10,
    show_default=True,
    help="Number of runs of each claim on games from random poses; with 0 "
    "these claims are left out, which takes some seconds.",
)
@click.option(
    "--legs-robot",
    default="",
    help="Folder of a robot whose description names a walking policy: also "
    "measure the paper's game on its learned legs.",
)
@click.option(
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("runs/reproduce"),
    show_default=True,
    help="Folder of the report. Measurements in it are reused if settings "
    "and results version are the same.",
)
@campaign_options
@json_option
def reproduce(
    seed: int,
    runs: int,
    legs_robot: str,
    output: Path,
    campaign: CampaignOptions,
    as_json: bool,
) -> None:
    """Measure every claim of the paper and write a report.

    Takes a few minutes. Finished measurements are saved, so that an
    interrupted reproduction can be continued with the same command. The exit
    status is 1 if a claim fails.
    """
    from ..studies.claims import claim_rows, claim_study

    check_folder(output, new=False)
    study = claim_study(range(seed, seed + runs), legs_robot)
    announce_effort(
        f"every claim of the paper, {runs} runs of those in physics",
        (20 + 120 * runs) / campaign.shard[1],
        campaign.workers,
    )
    run = run_campaign(study, output / RECORDS, campaign, "runs")
    finish_campaign(run, "runs")
    if campaign.shard[1] > 1:
        echo(f"results: {output}", err=as_json)
        return
    rows = claim_rows(run)
    page: Path | None = None
    lost: OutputError | None = None
    try:
        page = _write_all(output, (seed, runs, legs_robot), rows)
    except KeyboardInterrupt:
        done = "all runs and completed figures"
        exit_interrupted(resume_message(done, output))
    except OutputError as error:
        lost = error
    _tell(rows, page, as_json)
    if not legs_robot:
        echo(SKIPPED, err=as_json)
    if lost is not None:
        raise lost
    if any(row["verdict"] != "holds" for row in rows):
        raise SystemExit(1)


def _write_all(
    output: Path, given: tuple[int, int, str], rows: list[dict[str, Any]]
) -> Path:
    """Write figures, results and the report.

    Args:
        output: Folder of the report.
        given: Seed, number of runs, and robot on learned legs.
        rows: Rows of all claims.
    """
    from ..report.claims_page import write_page
    from ..studies.paper_figures import paper_figures
    from ..studies.results_version import RESULTS, library_versions
    from .reproduce_figures import draw_figures, turns_shown

    seed, runs, legs_robot = given
    figures = draw_figures(output, seed if runs else None)
    made = {
        "seed": seed,
        "runs": runs,
        "results": RESULTS,
        "libraries": library_versions(),
    }
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
