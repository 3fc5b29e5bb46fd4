"""``stepaside reproduce``: measurement of every claim of the paper."""

import json
from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import atomic_draft, check_folder
from .options import (
    seed_option,
    shard_option,
    workers_option,
)
from .study_output import executor_option, finish_study, run_stored
from .terminal import (
    echo,
    exit_interrupted,
    json_option,
    print_json,
    resume_message,
)

RECORDS = "claims.sqlite"
SKIPPED = (
    "  skipped the paper's game on learned legs: --legs-robot names a robot "
    "with a walking policy"
)
SHOWN = 120.0  # of the duel in the figure, in [s]


@click.command("reproduce")
@seed_option(help="Random seed of the first run; later runs increment it.")
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
@workers_option
@executor_option
@shard_option
@json_option
def reproduce(
    seed: int,
    runs: int,
    legs_robot: str,
    output: Path,
    as_json: bool,
    **campaign: Any,
) -> None:
    """Measure every claim of the paper and write a report.

    Takes a few minutes. Finished measurements are saved, so that an
    interrupted reproduction can be continued with the same command. The exit
    status is 1 if a claim fails.
    """
    from ..studies.claims import claim_rows, claim_study

    check_folder(output, new=False)
    study = claim_study(range(seed, seed + runs), legs_robot)
    run = run_stored(study, output / RECORDS, **campaign)
    finish_study(run, "runs")
    if campaign["shard"][1] > 1:
        echo(f"results: {output}", err=as_json)
        return
    rows = claim_rows(run)
    if as_json:
        print_json({"rows": rows})
    else:
        for row in rows:
            echo(f"  {row['verdict']:<6} {row['section']:<13} {row['claim']}")
        held = sum(row["verdict"] == "holds" for row in rows)
        echo(f"\n{held} of {len(rows)} hold")
    if not runs:
        echo("  skipped the claims on games in physics: --runs 0", err=as_json)
    if not legs_robot:
        echo(SKIPPED, err=as_json)
    try:
        page = _write_page(output, (seed, runs), rows)
    except KeyboardInterrupt:
        done = "all runs and completed figures"
        exit_interrupted(resume_message(done, output))
    echo(f"page: {page}", err=as_json)
    if any(row["verdict"] != "holds" for row in rows):
        raise SystemExit(1)


def _write_page(
    output: Path, given: tuple[int, int], rows: list[dict[str, Any]]
) -> Path:
    """Write figures, results and the report; given are seed and runs."""
    from ..report.claims_page import markdown_page
    from ..studies.results_version import RESULTS, library_versions
    from ..studies.theory_claims import FIG_2, play

    seed, runs = given
    run = play(FIG_2)
    figures = draw_figures(output, run, seed if runs else None)
    made = {
        "seed": seed,
        "runs": runs,
        "results": RESULTS,
        "libraries": library_versions(),
    }
    with atomic_draft(output / "claims.json") as draft:
        text = json.dumps(made | {"rows": rows}, indent=1, allow_nan=False)
        draft.write_text(text + "\n", encoding="utf-8")
    page = output / "claims.md"
    with atomic_draft(page) as draft:
        text = markdown_page(rows, figures, made)
        draft.write_text(text, encoding="utf-8")
    return page


def draw_figures(
    folder: Path, game: Any, seed: int | None
) -> list[tuple[str, str]]:
    """Draw counterparts of Fig. 2 and Fig. 5, and a sweep over strategies.

    The game is that of Fig. 2, the seed that of the duel, if any. Returns
    caption and file name of each figure.
    """
    from ..games import duel, run_game
    from ..report.run_figure import draw_run
    from ..report.unicycle_figures import draw_game, draw_sweep

    draw_game(game, folder / "fig2.png")
    draw_sweep(game.game, folder / "sweep.png")
    drawn = [
        ("Unicycles under (1)-(4), in the manner of Fig. 2", "fig2.png"),
        (
            "The circle over angle and ratios: theory as lines, simulation "
            "as marks",
            "sweep.png",
        ),
    ]
    if seed is None:
        return drawn
    run = run_game(duel(seed=seed, duration=SHOWN)).uninterrupted()
    name = f"duel-seed{seed}.png"
    draw_run(run, folder / name)
    return [*drawn, ("Two NAOs in physics, in the manner of Fig. 5", name)]
