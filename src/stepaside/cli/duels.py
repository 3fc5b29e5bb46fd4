"""``stepaside duels``: many duels from many starts, on all cores."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import check_folder
from ..core.errors import OutputError
from .campaign_reports import CampaignOutcome, gather, tell_aside
from .duel_options import duel_options
from .effort_estimate import SIMULATED, tell_effort
from .interruption import kept_in, leave_stopped
from .options.common_options import (
    FIGURE,
    FOLDER,
    WORKERS,
    figure_width,
    json_option,
)
from .options.declaration import OptionDeclaration
from .options.game_options import SEED
from .options.settings_command import SettingsCommand
from .output_files import attempt, writes_files
from .progress import show_progress
from .terminal import echo
from .value_labels import label_of
from .value_types import print_json

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings

LARGEST = 100_000  # duels of one call
RECORDS, SUMMARY, DRAWN = "duels.jsonl", "summary.json", "duels.png"


class SeedsType(click.ParamType[range]):
    """Seeds: ``0:1000`` are the thousand from 0 to 999, ``7`` is one."""

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


SEEDS = OptionDeclaration(
    "--seeds", "One duel each; the end is not among them.", kind=SeedsType()
)


@click.command("duels", cls=SettingsCommand)
@SEEDS.option(default="0:40", show_default=True)
@duel_options(SEED)
@WORKERS.option()
@click.option(
    "--verify",
    type=click.IntRange(1, 100_000),
    metavar="N",
    help="Play N recorded duels again; if all come out the same, take over "
    "the records that an older version of the code made, else end with exit "
    "status 1.",
)
@FOLDER.option(
    help="Folder of results, which goes on with what it holds; runs/duels "
    "by default, none with --json."
)
@FIGURE.option(help="Write the figure here, too (.png, .svg or .pdf).")
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
    """Play many duels and say what came out, how surely, what was worst.

    Outcomes, radii, distance, orientation, convergence and closest approach
    with 95 % intervals, and the seeds that come worst, each of which
    `stepaside duel --seed` replays. A study that was stopped goes on where it
    was when it is started again with the same folder.
    """
    if output is None and not as_json:
        output = Path("runs") / "duels"
    if output is not None:
        check_folder(output, new=False)
    if verify is not None:
        _verify(settings, output, verify, workers)
    each = settings.duration
    tell_effort(
        f"{len(seeds)} duels of {each:g} s, less those that are recorded",
        len(seeds) * each / SIMULATED,
        workers,
    )
    records, ended = _play(settings, seeds, output, workers)
    answer = _answer(settings, seeds, records)
    failed = ended.failed
    if output is not None and records and failed is None:
        from ..studies.result_files import write_result

        try:
            answer = write_result(output / SUMMARY, answer)
            if ended.whole:
                _draw(records, answer, output / DRAWN)
        except OutputError as error:
            failed = error
    if figure is not None and records and ended.whole:
        drawn = Path(figure)
        attempt(lambda: _draw(records, answer, drawn))
    if as_json:
        print_json(answer)
    else:
        _print(answer["summary"])
        echo(f"\nresults: {output}")
    if failed is not None:
        raise failed
    if ended.stopped:
        done = f"{len(records)} of {len(seeds)} duels"
        leave_stopped(kept_in(done, output and output / RECORDS))


def _draw(
    records: list[dict[str, Any]], answer: dict[str, Any], file: Path
) -> None:
    from ..report.duels_figure import draw_duels  # loads for a second

    draw_duels({"": records}, answer["summary"], file)


def _file(output: Path | None) -> Any:
    from ..studies.record_store import RecordStore

    return None if output is None else RecordStore(output / RECORDS)


def _verify(
    settings: "DuelSettings",
    output: Path | None,
    number: int,
    workers: int | None,
) -> None:
    """Take over older records, or end and say which came out otherwise."""
    from ..core.worker_pool import worker_pool
    from ..studies.duel_campaign import verify_duels

    if output is None or not (output / RECORDS).exists():
        raise click.UsageError(
            f"--verify needs an --output that holds records, got {output}"
        )
    with worker_pool(workers) as executor:
        played, differ = verify_duels(
            settings, _file(output), number, executor
        )
    same = len(played) - len(differ)
    echo(f"{same} of {len(played)} duels came out the same", err=True)
    if differ:
        echo(
            f"stepaside: seeds {', '.join(map(str, differ))} came out "
            "otherwise; nothing was taken over or played",
            err=True,
        )
        raise SystemExit(1)


def _play(
    settings: "DuelSettings",
    seeds: range,
    output: Path | None,
    workers: int | None,
) -> tuple[list[dict[str, Any]], CampaignOutcome]:
    """Play with a progress bar, and say how it ended."""
    from ..core.worker_pool import worker_pool
    from ..studies.duel_campaign import run_duels

    file = _file(output)
    done: dict[str, dict[str, Any]] = {}
    with (
        show_progress("duels", len(seeds), "duels") as bar,
        worker_pool(workers) as executor,
    ):

        def report(number: int) -> None:
            bar.n = number
            bar.refresh()

        ended = gather(
            lambda: run_duels(settings, seeds, file, executor, report, done),
            None if file is None else file.path,
            lambda: done,
        )
    if file is not None and file.aside:
        tell_aside(file.path.with_name(file.path.name + ".aside"))
    return sorted(done.values(), key=lambda r: int(r["seed"])), ended


def _answer(
    settings: "DuelSettings", seeds: range, records: list[dict[str, Any]]
) -> dict[str, Any]:
    from ..games.configuration_file import spelled_settings
    from ..studies.duel_campaign import stamps_of
    from ..studies.duel_statistics import summarise_duels
    from ..studies.result_files import header

    entries = spelled_settings(settings)
    del entries["seed"]  # the seeds stand above
    return {
        **header(entries),
        "played_by": stamps_of(records),
        "seeds": f"{seeds.start}:{seeds.stop}",
        "summary": summarise_duels(settings, records),
    }


def _print(summary: dict[str, Any]) -> None:
    for name, share in summary["outcomes"].items():
        if share["number"]:
            echo(_share(name, share))
    echo(_share("on the circle", summary["on_the_circle"]))
    by = f"before {summary['on_the_circle_by_s']:.0f} s"
    echo(_share(by, summary["on_the_circle_in_time"]))
    echo(
        f"\n{'':<34}{'theory':>9}{'mean':>9}{'+-95 %':>9}"
        f"{'least':>9}{'greatest':>9}  worst seed"
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


def _share(name: str, share: dict[str, float]) -> str:
    return (
        f"{name:<20}{share['number']:>5} of {share['of']}"
        f"   95 %: {100 * share['low']:.1f}-{100 * share['high']:.1f} %"
    )
