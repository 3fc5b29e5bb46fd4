"""``stepaside study``: any grid or list of settings of a game."""

from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import check_file
from ..report.study_table import study_table
from .options import (
    EXISTING_FILE,
    TextType,
    figure_option,
    shard_option,
    workers_option,
)
from .study_output import executor_option, finish_study, run_stored
from .terminal import echo, json_option, print_json, write_result

SUFFIX = ".sqlite"


def _records(text: str) -> Path:
    """Return a file of records, which may exist, checked."""
    check_file(Path(text), "--output", suffixes=(SUFFIX,), overwrite=True)
    return Path(text)


@click.command("study")
@click.argument("source", metavar="PRESET|FILE")
@click.argument(
    "parts",
    nargs=-1,
    metavar="[PART]...",
    type=EXISTING_FILE,
)
@click.option(
    "--set",
    "sets",
    multiple=True,
    metavar="PATH=VALUE",
    help="Change a setting (duration=60), what varies "
    "(evader=robust,look-ahead, seed=0:10) or choose variants (method=mpc); "
    "repeatable.",
)
@click.option(
    "--by",
    multiple=True,
    metavar="NAME",
    help="Value that tells the rows of the table apart; repeatable.",
)
@click.option(
    "--value",
    "values",
    multiple=True,
    metavar="NAME",
    help="Value of the table; repeatable.",
)
@click.option(
    "--settings",
    "shows",
    is_flag=True,
    help="Print the file of the study, to copy it, and end.",
)
@click.option(
    "--output",
    type=TextType("FILE", _records),
    help="SQLite file of the records; an interrupted study in it is "
    "continued.",
)
@workers_option
@executor_option
@shard_option
@figure_option(help="Write a figure of the first value.")
@json_option
def study(
    source: str,
    sets: tuple[str, ...],
    by: tuple[str, ...],
    values: tuple[str, ...],
    shows: bool,
    output: Path | None,
    parts: tuple[Path, ...],
    figure: Path | None,
    as_json: bool,
    **campaign: Any,
) -> None:
    """Play all combinations of settings of a PRESET or FILE.

    Presets: duels, tournament, rating, pursuers, robustness, pushes and
    people. FILE is TOML with game, settings that all cases share, and a grid
    of values, or a game file; see docs/campaigns.md. Prints shares and means
    with 95 % intervals for each combination of settings, over all seeds. The
    records of the files PART of shards are first added to --output.
    """
    from ..studies.study import merge_results
    from ..studies.study_design import load_study, preset_file

    if shows:
        write_result(preset_file(source).read_text("utf-8"))
        return
    made = load_study(source, sets, by=by, values=values)
    if parts:
        if output is None:
            raise click.UsageError("files of shards require --output")
        merge_results(parts, output)
    run = run_stored(made, output, **campaign)
    rows = run.table() if run.finished else []
    if as_json:
        print_json({"planned": run.total, "done": run.finished, "rows": rows})
    elif rows:
        echo(study_table(rows, made.by, made.values))
    if figure is not None and run.completed:
        from ..report.study_figures import draw_study

        draw_study(rows, made.by, str(figure))
    finish_study(run, "games")
