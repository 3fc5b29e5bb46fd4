"""``stepaside study``: any grid or list of settings of a game."""

from pathlib import Path
from typing import Any

import click

from .campaign_options import CampaignOptions, campaign_options
from .campaign_reports import finish_campaign, run_campaign
from .options.common_options import json_option
from .output_files import attempt, writes_files
from .terminal import echo, print_json

SUMMARY = "summary.json"


@click.command("study")
@click.argument(
    "file", type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
@click.option(
    "--value",
    "values",
    multiple=True,
    metavar="NAME",
    help="Value of a record to tabulate; repeatable.  [default: the closest "
    "approach, or the speed of a walk]",
)
@campaign_options(
    "Folder of results; an interrupted study in it is continued. None by "
    "default."
)
@json_option
@writes_files
def study(
    file: Path,
    values: tuple[str, ...],
    campaign: CampaignOptions,
    as_json: bool,
) -> None:
    """Run the grid or list of settings in FILE.

    FILE is TOML with game (duel, walk, tournament or unicycles), settings
    that all cases share, and a grid of values or a list of cases; see
    docs/campaigns.md. Prints outcomes and values for each combination of
    settings, over all seeds.
    """
    from ..studies.result_files import header, write_result
    from ..studies.sweep import load_sweep, sweep_rows, sweep_study

    sweep = load_sweep(file)
    run = run_campaign(sweep_study(sweep), campaign, "cases", few=1)
    rows = sweep_rows(sweep, run.items(), values)
    settings = {"game": sweep.game, "settings": sweep.base}
    result: dict[str, Any] = {
        **header(settings),
        "planned": run.total,
        "done": run.finished,
        "rows": rows,
    }
    if campaign.output is not None and run.finished and campaign.is_whole:
        summary = campaign.output / SUMMARY
        attempt(lambda: result.update(write_result(summary, result)))
    if as_json:
        print_json(result)
    else:
        _print(rows)
    finish_campaign(run, campaign, "cases")


def _print(rows: list[dict[str, Any]]) -> None:
    """Print one line per combination of settings."""
    for row in rows:
        settings = ", ".join(
            f"{name}={value:.6g}"
            if isinstance(value, float)
            else f"{name}={value}"
            for name, value in row["settings"].items()
        )
        number = row["cases"]
        cases = "1 case" if number == 1 else f"{number} cases"
        outcomes = ", ".join(f"{n} {k}" for k, n in row["outcomes"].items())
        echo(f"{settings or 'all'}: {cases}, {outcomes}")
        for name in list(row)[3:]:
            found = row[name]
            echo(
                f"    {name}: none"
                if found is None
                else f"    {name}: {found['mean']:.4g} +- "
                f"{found['half_interval']:.2g} (95 %), {found['least']:.4g} "
                f"to {found['greatest']:.4g}"
            )
