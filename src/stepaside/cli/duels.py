"""``stepaside duels``: a study of duels from many initial poses."""

import re
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import check_folder
from ..core.errors import OutputError
from .campaign_reports import (
    CampaignOutcome,
    report_set_aside,
    run_campaign_work,
)
from .effort_estimate import SIMULATED, announce_effort
from .interruption import exit_interrupted, resume_message
from .options.common_options import (
    figure_option,
    figure_width,
    folder_option,
    json_option,
    workers_option,
)
from .options.duel_options import duel_options
from .options.settings_command import SettingsCommand
from .output_files import attempt, writes_files
from .progress import show_progress
from .tables import label_of
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings

LARGEST = 100_000  # number of duels of one study
RECORDS = "duels.jsonl"
SUMMARY = "summary.json"
FIGURE_NAME = "duels.png"


class SeedsType(click.ParamType[range]):
    """Range of seeds: ``0:1000`` for 0 to 999, ``7`` for one seed."""

    name = "FIRST:END"

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> range:
        """Parse a range of seeds."""
        if isinstance(value, range):
            return value
        found = re.fullmatch(r"(\d{1,9})(?::(\d{1,9}))?", str(value).strip())
        if found is None:
            self.fail(
                "must be FIRST:END or one seed, integers >= 0 [1] like "
                f"0:1000, got {value!r}",
                param,
                ctx,
            )
        first = int(found[1])
        end = first + 1 if found[2] is None else int(found[2])
        if not 1 <= end - first <= LARGEST:
            self.fail(
                f"END must be 1 to {LARGEST} past FIRST [1], got {value!r}",
                param,
                ctx,
            )
        return range(first, end)


seeds_option = partial(
    click.option,
    "--seeds",
    type=SeedsType(),
    show_default=True,
    help="Range of seeds, one duel each; END is excluded.",
)


@click.command("duels", cls=SettingsCommand)
@seeds_option(default="0:40")
@duel_options("seed")
@workers_option()
@click.option(
    "--verify",
    type=click.IntRange(1, 100_000),
    metavar="N",
    help="Repeat N recorded duels. If all results agree, reuse the records "
    "of an older version of the code; otherwise exit with status 1.",
)
@folder_option(
    help="Folder of results; an interrupted study in it is continued. "
    "runs/duels by default, none with --json."
)
@figure_option(help="Write a copy of the figure (.png, .svg or .pdf).")
@figure_width
@json_option
@writes_files
def duels(
    settings: "DuelSettings",
    seeds: range,
    workers: int | None,
    verify: int | None,
    output: Path | None,
    figure: str | None,
    as_json: bool,
) -> None:
    """Simulate many duels and summarise them with confidence intervals.

    Prints outcomes, radii, distance, angle between headings, convergence and
    closest approach with 95 % intervals, and the seeds of the worst duels,
    which `stepaside duel --seed` repeats. To continue an interrupted study,
    run it again with the same folder.
    """
    if output is None and not as_json:
        output = Path("runs") / "duels"
    if output is not None:
        check_folder(output, new=False)
    if verify is not None:
        _verify(settings, output, verify, workers)
    duration = settings.duration
    announce_effort(
        f"{len(seeds)} duels of {duration:g} s, fewer if some are recorded",
        len(seeds) * duration / SIMULATED,
        workers,
    )
    records, ended = _run(settings, seeds, output, workers)
    result = _result(settings, seeds, records)
    failed = ended.failed
    if output is not None and records and failed is None:
        from ..studies.result_files import write_result

        try:
            result = write_result(output / SUMMARY, result)
            if ended.completed:
                _draw(records, result, output / FIGURE_NAME)
        except OutputError as error:
            failed = error
    if figure is not None and records and ended.completed:
        copy = Path(figure)
        attempt(lambda: _draw(records, result, copy))
    if as_json:
        print_json(result)
    else:
        _print(result["summary"])
        echo(f"\nresults: {output}")
    if failed is not None:
        raise failed
    if ended.stopped:
        done = f"{len(records)} of {len(seeds)} duels"
        exit_interrupted(resume_message(done, output and output / RECORDS))


def _draw(
    records: list[dict[str, Any]], result: dict[str, Any], file: Path
) -> None:
    from ..report.duels_figure import draw_duels  # Matplotlib takes a second

    draw_duels({"": records}, result["summary"], file)


def _record_store(output: Path | None) -> Any:
    from ..studies.record_store import RecordStore

    return None if output is None else RecordStore(output / RECORDS)


def _verify(
    settings: "DuelSettings",
    output: Path | None,
    number: int,
    workers: int | None,
) -> None:
    """Validate older records; exit with the seeds that differ, if any."""
    from ..core.worker_pool import worker_pool
    from ..studies.duel_campaign import verify_duels

    if output is None or not (output / RECORDS).exists():
        raise click.UsageError(
            f"--verify requires an --output with records, got {output}"
        )
    with worker_pool(workers) as executor:
        repeated, differ = verify_duels(
            settings, _record_store(output), number, executor
        )
    same = len(repeated) - len(differ)
    echo(f"{same} of {len(repeated)} repeated duels agree", err=True)
    if differ:
        echo(
            f"stepaside: the results of seeds {', '.join(map(str, differ))} "
            "differ; no record was reused, no further duel run",
            err=True,
        )
        raise SystemExit(1)


def _run(
    settings: "DuelSettings",
    seeds: range,
    output: Path | None,
    workers: int | None,
) -> tuple[list[dict[str, Any]], CampaignOutcome]:
    """Run the duels with a progress bar; return records and outcome."""
    from ..core.worker_pool import worker_pool
    from ..studies.duel_campaign import run_duels

    file = _record_store(output)
    done: dict[str, dict[str, Any]] = {}
    with (
        show_progress("duels", len(seeds), "duels") as bar,
        worker_pool(workers) as executor,
    ):

        def report(number: int) -> None:
            bar.n = number
            bar.refresh()

        ended = run_campaign_work(
            lambda: run_duels(settings, seeds, file, executor, report, done),
            None if file is None else file.path,
            lambda: done,
        )
    if file is not None and file.aside:
        report_set_aside(file.path.with_name(file.path.name + ".aside"))
    return sorted(done.values(), key=lambda r: int(r["seed"])), ended


def _result(
    settings: "DuelSettings", seeds: range, records: list[dict[str, Any]]
) -> dict[str, Any]:
    from ..games.configuration_file import json_settings
    from ..studies.duel_campaign import versions_of
    from ..studies.duel_statistics import summarise_duels
    from ..studies.result_files import header

    entries = json_settings(settings)
    del entries["seed"]  # the result has an entry for all seeds
    return {
        **header(entries),
        "played_by": versions_of(records),
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
    echo(
        f"\n{'':<34}{'theory':>9}{'mean':>9}{'+-95 %':>9}"
        f"{'min':>9}{'max':>9}  worst seed"
    )
    for name, row in summary["figures"].items():
        theory = "" if row["theory"] is None else f"{row['theory']:.3f}"
        half = row["mean_high"] - row["mean"]
        echo(
            f"{label_of(name, unit=True):<34}{theory:>9}"
            f"{row['mean']:>9.3f}{half:>9.3f}"
            f"{row['least']:>9.3f}{row['greatest']:>9.3f}"
            f"  {row['worst_seed']}"
        )
    for entry in summary["not_completed"]:
        echo(f"seed {entry['seed']}: {entry['message']}")


def _proportion(name: str, count: dict[str, float]) -> str:
    """Return one line with a proportion and its 95 % interval."""
    return (
        f"{name:<20}{count['number']:>5} of {count['of']}"
        f"   95 %: {100 * count['low']:.1f}-{100 * count['high']:.1f} %"
    )
