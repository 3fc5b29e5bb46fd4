"""Output files of commands: checked before work, errors reported after it."""

import os
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import check_file
from ..core.errors import ConfigurationError, OutputError
from .options.parameter_types import OutputFile
from .terminal import NOTHING_SAVED, exit_interrupted, resume_message

overwrite_option = click.option(
    "--overwrite/--no-overwrite",
    default=False,
    help="Replace existing files.",
)
FAILED = "stepaside.core.atomic_output.failed"
RECORDS = "stepaside.cli.output_files.records"


def writes_files(function: Callable[..., Any]) -> Callable[..., Any]:
    """Check a command's output files first; overwrite only with a flag.

    Errors on writing are raised when the command has finished; see
    :func:`attempt`.
    """

    @overwrite_option
    @wraps(function)
    def command(overwrite: bool, **values: Any) -> Any:
        context = click.get_current_context()
        try:
            _check(context, overwrite)
        except ConfigurationError as error:
            raise click.UsageError(str(error)) from error
        before = _files(context)
        exit_status: SystemExit | None = None
        result = None
        try:
            result = function(**values)
        except KeyboardInterrupt:
            exit_interrupted(saved_text(context, before))
        except SystemExit as status:
            exit_status = status
        for failed in context.meta.get(FAILED, ())[:1]:
            raise failed
        if exit_status is not None:
            raise exit_status
        return result

    return command


def _files(context: click.Context) -> dict[str, tuple[int, ...]]:
    """Return the existing output files with inode, time and size of each."""
    existing: dict[str, tuple[int, ...]] = {}
    for param in context.command.params:
        value = context.params.get(param.name or "")
        if isinstance(param.type, OutputFile) and value is not None:
            with suppress(OSError):
                stat = os.stat(value)
                existing[value] = (stat.st_ino, stat.st_mtime_ns, stat.st_size)
    return existing


def note_records(file: Path) -> None:
    """Note where the command records a study, for its interruption."""
    click.get_current_context().meta[RECORDS] = file


def saved_text(
    context: click.Context, before: dict[str, tuple[int, ...]] | None = None
) -> str:
    """Return a sentence that names what an interrupted command has saved.

    Args:
        context: Context of the command.
        before: Its output files before it began.
    """
    now = _files(context)
    old = now if before is None else before
    new = [file for file, stat in now.items() if old.get(file) != stat]
    records = context.meta.get(RECORDS)
    if records is not None and _has_records(records):
        return resume_message(", ".join(["finished cases", *new]), records)
    return f"saved: {', '.join(new)}" if new else NOTHING_SAVED


def _has_records(file: Path) -> bool:
    from ..studies.study import count_records

    return count_records(file) > 0


def _check(context: click.Context, overwrite: bool) -> None:
    """Refuse output files that cannot be written, or that coincide."""
    taken: dict[Path, str] = {}
    for param in context.command.params:
        value = context.params.get(param.name or "")
        if not isinstance(param.type, OutputFile) or value is None:
            continue
        file, name = Path(value), param.opts[0]
        check_file(
            file,
            name,
            suffixes=param.type.suffixes,
            overwrite=overwrite,
        )
        other = taken.setdefault(file.resolve(), name)
        if other != name:
            raise ConfigurationError(
                f"{name} must differ from the file of {other}, got {value!r}"
            )


def attempt(write: Callable[[], Any]) -> bool:
    """Write a file; on an output error, raise it after the command.

    Args:
        write: Writes the file.

    Returns:
        Whether the file is written.
    """
    try:
        write()
    except OutputError as error:
        context = click.get_current_context()
        context.meta.setdefault(FAILED, []).append(error)
        return False
    return True


__all__ = [
    "OutputFile",
    "attempt",
    "note_records",
    "saved_text",
    "writes_files",
]
