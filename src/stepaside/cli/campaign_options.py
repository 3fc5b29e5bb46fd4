"""Options of campaigns: workers, executor, shard, output."""

import re
from collections.abc import Callable
from functools import partial, wraps
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import click

from ..core.atomic_output import check_folder
from ..studies.executors import PROCESSES, SPECIFICATIONS, check_executor
from .options.common_options import workers_option
from .options.parameter_types import TextType
from .output_files import note_records, saved_text
from .terminal import exit_interrupted

C = TypeVar("C")


class ShardType(TextType[tuple[int, int]]):
    """Part of the cases of a campaign: ``2/4`` for the second of four."""

    name = "I/N"

    def parse(self, value: Any) -> tuple[int, int]:
        """Parse the number of a shard and of all shards."""
        if isinstance(value, tuple):
            return value
        found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", str(value).strip())
        if found is None or not 1 <= int(found[1]) <= int(found[2]):
            raise click.BadParameter(
                "must be I/N with integers 1 <= I <= N [1] like 1/4, "
                f"got {value!r}"
            )
        return int(found[1]), int(found[2])


class ExecutorType(TextType[str]):
    """Specification of an executor."""

    name = "EXECUTOR"

    def parse(self, value: Any) -> str:
        """Refuse a specification of no executor."""
        check_executor(str(value))
        return str(value)


executor_option = partial(
    click.option,
    "--executor",
    type=ExecutorType(),
    default=PROCESSES,
    show_default=True,
    help=f"Where cases run: {SPECIFICATIONS}; see docs/campaigns.md.",
)
shard_option = partial(
    click.option,
    "--shard",
    type=ShardType(),
    help="Run every N-th case only, from the I-th; `stepaside merge` joins "
    "the outputs.",
)


class CampaignOptions(NamedTuple):
    """Where a campaign runs, which part of it, and where results go.

    Attributes:
        workers: Number of processes; all cores if None.
        executor: Specification of the executor; see
            :func:`~stepaside.studies.executors.open_executor`.
        shard: Number of the shard, from 1, and number of shards.
        output: Folder of results; None to store nothing.
    """

    workers: int | None = None
    executor: str = PROCESSES
    shard: tuple[int, int] | None = None
    output: Path | None = None

    def file_of(self, study: str) -> Path | None:
        """Return the file of the records of a study; None to store none."""
        return None if self.output is None else self.output / f"{study}.sqlite"

    def with_default(self, output: Path) -> "CampaignOptions":
        """Return the options with an output folder if there was none.

        Raises:
            ConfigurationError: If it cannot be written to.
        """
        if self.output is not None:
            return self
        check_folder(output, new=False)
        made = self._replace(output=output)
        note_records(output)
        return made

    @property
    def is_whole(self) -> bool:
        """Whether this is the whole campaign."""
        return self.shard is None

    def share(self, cases: int) -> int:
        """Return how many of some cases are in the shard, about."""
        return cases if self.shard is None else -(-cases // self.shard[1])


def campaign_options(
    output_help: str,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Add the options of a campaign, passed as ``campaign``.

    Args:
        output_help: Help of ``--output``.
    """

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def command(
            *args: Any,
            workers: int | None,
            executor: str,
            shard: tuple[int, int] | None,
            output: Path | None,
            **values: Any,
        ) -> Any:
            if output is not None:
                check_folder(output, new=False)
            campaign = CampaignOptions(workers, executor, shard, output)
            if output is not None:
                note_records(output)
            try:
                return function(*args, campaign=campaign, **values)
            except KeyboardInterrupt:
                exit_interrupted(saved_text(click.get_current_context()))

        output_option = click.option(
            "--output",
            type=click.Path(file_okay=False, path_type=Path),
            help=output_help,
        )
        for option in (
            output_option,
            shard_option(),
            executor_option(),
            workers_option(),
        ):
            command = option(command)
        return command

    return decorate
