"""Execution of campaigns, with progress and messages about records."""

from typing import TYPE_CHECKING, TypeVar

from ..core.progress import show_progress
from .campaign_options import CampaignOptions
from .terminal import echo, exit_interrupted, resume_message

if TYPE_CHECKING:
    from ..studies.study import Study, StudyProgress, StudyRun

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
    from ..studies.executors import PROCESSES
    from ..studies.study import run_study

    number = campaign.share(len(study.cases))
    inline = campaign.executor == PROCESSES and (
        len(study.cases) <= few or (few and campaign.workers == 1)
    )
    with show_progress(study.name, number, unit) as bar:

        def report(progress: "StudyProgress") -> None:
            bar.initial, bar.n = progress.reused, progress.finished
            bar.refresh()

        return run_study(
            study,
            campaign.file_of(study.name),
            executor=None if inline else campaign.executor,
            workers=None if inline else campaign.workers,
            shard=campaign.shard or (1, 1),
            report=report,
            warn=lambda message: echo(message, err=True),
        )


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
        done = f"{run.finished} of {run.total} {unit}"
        exit_interrupted(resume_message(done, run.file))
