"""``stepaside study``: any grid or list of settings of a game."""

from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import check_file
from .campaign_options import (
    CampaignOptions,
    campaign_options,
    finish_campaign,
    run_campaign,
)
from .options.common_options import figure_option, json_option
from .options.parameter_types import TextType
from .output_files import attempt, writes_files
from .tables import label_of, print_columns
from .terminal import print_json, write_result

SUFFIX = ".sqlite"


class RecordsFile(TextType[Path]):
    """SQLite file of records, which may exist."""

    name = "FILE"

    def parse(self, value: Any) -> Path:
        """Refuse a file that cannot be written."""
        file = Path(value)
        check_file(file, "--output", suffixes=(SUFFIX,), overwrite=True)
        return file


@click.command("study")
@click.argument("source", metavar="PRESET|FILE")
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
    help="Value that tells the rows of the table apart; repeatable.  "
    "[default: those of the study]",
)
@click.option(
    "--value",
    "values",
    multiple=True,
    metavar="NAME",
    help="Value of the table; repeatable.  [default: those of the study]",
)
@click.option(
    "--print/--no-print",
    "shows",
    default=False,
    help="Print the file of the study, to copy it, and end.",
)
@click.option(
    "--output",
    type=RecordsFile(),
    help="SQLite file of the records; an interrupted study in it is "
    "continued. None by default.",
)
@campaign_options
@figure_option(help="Write a figure of the first value.")
@json_option
@writes_files
def study(
    source: str,
    sets: tuple[str, ...],
    by: tuple[str, ...],
    values: tuple[str, ...],
    shows: bool,
    output: Path | None,
    campaign: CampaignOptions,
    figure: str | None,
    as_json: bool,
) -> None:
    """Play all combinations of settings of a PRESET or FILE.

    Presets: duels, tournament, rating, pursuers, robustness, pushes and
    people. FILE is TOML with game, settings that all cases share, and a grid
    of values, or a game file; see docs/campaigns.md. Prints shares and means
    with 95 % intervals for each combination of settings, over all seeds.
    """
    from ..studies.study_design import load_study, preset_file

    if shows:
        write_result(preset_file(source).read_text("utf-8"))
        return
    made = load_study(source, sets)
    run = run_campaign(made, output, campaign, "games")
    rows = run.table(by, values) if run.finished else []
    if figure is not None and run.completed:
        from ..report.study_figures import draw_study

        names = by or made.by
        attempt(lambda: draw_study(rows, names, figure))
    if as_json:
        print_json({"planned": run.total, "done": run.finished, "rows": rows})
    else:
        print_rows(rows, by or made.by, values or made.values)
    finish_campaign(run, "games")


def print_rows(
    rows: list[dict[str, Any]], by: tuple[str, ...], values: tuple[str, ...]
) -> None:
    """Print a row for each group: shares and means with 95 % intervals.

    Args:
        rows: Rows of :func:`stepaside.studies.tabulation.tabulate`.
        by: Names of the groups.
        values: Names of the values.
    """
    lines = [
        [
            *(_text(row[name]) for name in by),
            str(row["number"]),
            *(_cell(row[name]) for name in values),
        ]
        for row in rows
    ]
    heads = (*by, "games", *(label_of(name, unit=True) for name in values))
    if len(rows) > 1:
        print_columns(heads, lines, left=range(len(by)))
        return
    for line in lines:  # a single row reads better as a list
        print_columns(
            ("", ""), list(map(list, zip(heads, line, strict=True))), left=(0,)
        )


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _cell(found: Any) -> str:
    """Return the statistics of a value as text."""
    if found is None:
        return "-"
    if "mean" in found:
        half = f" ±{found['half']:.2g}" if found["half"] else ""
        return f"{found['mean']:.4g}{half}"
    if "share" in found:
        low, high = 100 * found["low"], 100 * found["high"]
        return f"{100 * found['share']:.0f} % ({low:.0f}-{high:.0f})"
    return ", ".join(f"{each['count']} {text}" for text, each in found.items())
