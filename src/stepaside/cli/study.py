"""``stepaside study``: any grid or list of settings of a game."""

from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import check_file
from ..report.result_labels import in_unit, label_of
from .options import (
    TextType,
    figure_option,
    shard_option,
    workers_option,
)
from .study_output import executor_option, finish_study, run_stored
from .tables import print_columns, print_table
from .terminal import json_option, print_json, write_result

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
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
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
    made = load_study(source, sets)
    if parts:
        if output is None:
            raise click.UsageError("files of shards require --output")
        merge_results(parts, output)
    run = run_stored(made, output, **campaign)
    rows = run.table(by, values) if run.finished else []
    if as_json:
        print_json({"planned": run.total, "done": run.finished, "rows": rows})
    else:
        _print(rows, by or made.by, values or made.values)
    if figure is not None and run.completed:
        from ..report.study_figures import draw_study

        draw_study(rows, by or made.by, str(figure))
    finish_study(run, "games")


def _print(
    rows: list[dict[str, Any]], by: tuple[str, ...], values: tuple[str, ...]
) -> None:
    """Print a row for each group: shares and means with 95 % intervals."""
    lines = [
        [
            *(_text(row[name]) for name in by),
            str(row["number"]),
            *(_cell(name, row[name]) for name in values),
        ]
        for row in rows
    ]
    heads = (*by, "games", *(label_of(name, unit=True) for name in values))
    if len(rows) > 1:
        print_columns(heads, lines, left=range(len(by)))
        return
    for line in lines:  # a single row reads better as a list
        print_table(list(zip(heads, line, strict=True)))


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _cell(name: str, found: Any) -> str:
    """Return the statistics of a value as text, in the unit of its name."""
    if found is None:
        return "-"
    if "mean" in found:
        mean, half = (in_unit(name, found[key]) for key in ("mean", "half"))
        return f"{mean:.4g}" + (f" ±{half:.2g}" if half else "")
    if "share" in found:
        low, high = 100 * found["low"], 100 * found["high"]
        return f"{100 * found['share']:.0f} % ({low:.0f}-{high:.0f})"
    return ", ".join(f"{each['count']} {text}" for text, each in found.items())
