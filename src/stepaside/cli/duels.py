"""``stepaside duels``: a study of duels from many initial poses."""

import re
from functools import partial
from pathlib import Path
from typing import Any

import click

from ..games.duel_settings import DuelSettings
from .campaign_options import CampaignOptions, campaign_options
from .campaign_reports import finish_campaign, run_campaign
from .options.common_options import (
    figure_option,
    figure_width,
    json_option,
)
from .options.parameter_types import TextType
from .options.settings_options import DUEL, takes_settings
from .output_files import attempt, writes_files
from .progress import SIMULATED, announce_effort
from .tables import interval, label_of, number, print_columns
from .terminal import echo, print_json

LARGEST = 10_000_000  # number of duels of one study
SUMMARY = "summary.json"
FIGURE_NAME = "duels.png"


class SeedsType(TextType[range]):
    """Range of seeds: ``0:1000`` for 0 to 999, ``7`` for one seed."""

    name = "FIRST:END"

    def parse(self, value: Any) -> range:
        """Parse a range of seeds."""
        if isinstance(value, range):
            return value
        found = re.fullmatch(r"(\d{1,9})(?::(\d{1,9}))?", str(value).strip())
        if found is None:
            raise click.BadParameter(
                "must be FIRST:END or one seed, integers >= 0 [1] like "
                f"0:1000, got {value!r}"
            )
        first = int(found[1])
        end = first + 1 if found[2] is None else int(found[2])
        if not 1 <= end - first <= LARGEST:
            raise click.BadParameter(
                f"END must be 1 to {LARGEST} past FIRST [1], got {value!r}"
            )
        return range(first, end)


seeds_option = partial(
    click.option,
    "--seeds",
    type=SeedsType(),
    show_default=True,
    help="Range of seeds, one duel each; END is excluded.",
)


@click.command("duels")
@seeds_option(default="0:40")
@takes_settings(DuelSettings, DUEL, without=("seed",))
@campaign_options(
    "Folder of results; an interrupted study in it is continued. runs/duels "
    "by default, none with --json."
)
@figure_option(help="Write a copy of the figure (.png, .svg or .pdf).")
@figure_width
@json_option
@writes_files
def duels(
    settings: DuelSettings,
    seeds: range,
    campaign: CampaignOptions,
    figure: str | None,
    as_json: bool,
) -> None:
    """Simulate many duels and summarise them with confidence intervals.

    Prints outcomes, radii, distance, angle between headings, convergence and
    closest approach with 95 % intervals, and the seeds of the worst duels,
    which `stepaside duel --seed` repeats. To continue an interrupted study,
    run it again with the same folder.
    """
    from ..studies.duel_campaign import duel_study
    from ..studies.result_files import write_result

    if not as_json:
        campaign = campaign.with_default(Path("runs") / "duels")
    duration, number = settings.duration, campaign.share(len(seeds))
    announce_effort(
        f"{number} duels of {duration:g} s, fewer if some are recorded",
        number * duration / SIMULATED,
        campaign.workers,
    )
    run = run_campaign(duel_study(settings, seeds), campaign, "duels")
    records = list(run.records())
    result = _result(settings, seeds, records)
    output = campaign.output
    if output is not None and records and campaign.is_whole:
        summary = output / SUMMARY
        attempt(lambda: result.update(write_result(summary, result)))
        if run.completed:
            drawn = output / FIGURE_NAME
            attempt(lambda: _draw(records, result, drawn))
    if figure is not None and run.completed:
        copy = Path(figure)
        attempt(lambda: _draw(records, result, copy))
    if as_json:
        print_json(result)
    else:
        _print(result["summary"])
        echo(f"\nresults: {output}")
    finish_campaign(run, campaign, "duels")


def _draw(
    records: list[dict[str, Any]], result: dict[str, Any], file: Path
) -> None:
    from ..report.duels_figure import draw_duels  # Matplotlib takes a second

    draw_duels({"": records}, result["summary"], file)


def _result(
    settings: DuelSettings, seeds: range, records: list[dict[str, Any]]
) -> dict[str, Any]:
    from ..games.configuration_file import json_settings
    from ..studies.duel_statistics import summarise_duels
    from ..studies.result_files import header

    entries = json_settings(settings)
    del entries["seed"]  # the result has an entry for all seeds
    return {
        **header(entries),
        "seeds": f"{seeds.start}:{seeds.stop}",
        "summary": summarise_duels(settings, records),
    }


def _print(summary: dict[str, Any]) -> None:
    for name, count in summary["outcomes"].items():
        if count["number"]:
            echo(_proportion(name, count))
    echo(_proportion("on the circle", summary["on_the_circle"]))
    by = f"before {summary['on_the_circle_by_s']:.0f} s"
    echo(_proportion(by, summary["on_the_circle_in_time"]))
    echo()
    print_columns(
        ("", "theory", "mean", "+-95 %", "min", "max", "worst seed"),
        [
            (
                label_of(name, unit=True),
                "" if row["theory"] is None else number(row["theory"]),
                number(row["mean"]),
                number(row["mean_high"] - row["mean"]),
                number(row["least"]),
                number(row["greatest"]),
                str(row["worst_seed"]),
            )
            for name, row in summary["figures"].items()
        ],
    )
    for entry in summary["not_completed"]:
        echo(f"seed {entry['seed']}: {entry['message']}")


def _proportion(name: str, count: dict[str, float]) -> str:
    """Return one line with a proportion and its 95 % interval."""
    return (
        f"{name:<20}{count['number']:>5} of {count['of']}"
        f"   95 %: {interval(count['low'], count['high'])}"
    )
