"""Execution of campaigns, with progress and messages about records."""

from contextlib import nullcontext
from typing import TYPE_CHECKING, TypeVar

from .campaign_options import CampaignOptions
from .progress import show_progress
from .terminal import echo, exit_interrupted, resume_message

if TYPE_CHECKING:
    from ..studies.campaign import CampaignProgress, Study, StudyRun
    from ..studies.result_store import ResultStore

C = TypeVar("C")


def run_campaign(
    study: "Study[C]",
    campaign: CampaignOptions,
    unit: str,
    *,
    few: int = 0,
) -> "StudyRun[C]":
    """Run a study, or one shard of it, with progress on standard error.

    Args:
        study: Study.
        campaign: Options of the campaign.
        unit: Unit of the progress, like ``duels``.
        few: Number of cases that take less time than starting worker
            processes, and are measured in this process.

    Returns:
        The results; see :func:`finish_campaign`.
    """
    from ..studies.campaign import run_study
    from ..studies.executors import POOL, Engine, open_engine
    from ..studies.result_table import write_table

    if campaign.shard is not None:
        study = study.shard(*campaign.shard)
    store = campaign.store
    with (
        show_progress(study.name, len(study.cases), unit) as bar,
        nullcontext(Engine.of(None))
        if campaign.executor == POOL
        and (len(study.cases) <= few or (few and campaign.workers == 1))
        else open_engine(campaign.executor, campaign.workers) as engine,
    ):

        def report(progress: "CampaignProgress") -> None:
            bar.initial, bar.n = progress.reused, progress.finished
            bar.refresh()

        run = run_study(study, store, engine, report, report_loss)
    report_invalid_lines(run.store)
    if campaign.table is not None and run.failure is None:
        write_table(run.records(), campaign.table)
    return run


def finish_campaign(
    run: "StudyRun[C]", campaign: CampaignOptions, unit: str
) -> None:
    """End a command whose campaign could not be completed.

    Raises:
        OutputError: If a record could not be written.
        SystemExit: After Ctrl-C, with the status of its signal.
    """
    if run.failure is not None:
        raise run.failure
    if run.interrupted:
        done = f"{run.finished} of {len(run.study.cases)} {unit}"
        exit_interrupted(
            resume_message(done, campaign.output and campaign.records)
        )


def report_loss(message: str) -> None:
    """Print that a worker was lost."""
    echo(f"stepaside: {message}", err=True)


def report_invalid_lines(store: "ResultStore") -> None:
    """Print which files have lines that are no records."""
    for file, number in store.invalid_lines.items():
        echo(
            f"stepaside: {number} incomplete or foreign "
            f"{'line' if number == 1 else 'lines'} of {file} ignored; the "
            "records are computed again",
            err=True,
        )
