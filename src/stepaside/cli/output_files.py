"""Files that commands write: checked first, and told of at the end."""

import os
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import check_file
from ..core.errors import ConfigurationError, OutputError
from .interruption import NOTHING, leave_stopped
from .options.declaration import OptionDeclaration
from .options.value_kinds import OutputFile

OVERWRITE = OptionDeclaration(
    "--overwrite/--no-overwrite", "Replace files that are there already."
)
FAILED = "stepaside.core.atomic_output.failed"


def writes_files(function: Callable[..., Any]) -> Callable[..., Any]:
    """Let a command with files to write check them, and ask before loss.

    What fails later is told when the command is through; see
    :func:`attempt`.
    """

    @OVERWRITE.option(default=False)
    @wraps(function)
    def command(overwrite: bool, **values: Any) -> Any:
        context = click.get_current_context()
        try:
            _check(context, overwrite)
        except ConfigurationError as error:
            raise click.UsageError(str(error)) from error
        before = _files(context)
        left: SystemExit | None = None
        answer = None
        try:
            answer = function(**values)
        except KeyboardInterrupt:
            leave_stopped(_kept(before, _files(context)))
        except SystemExit as status:
            left = status
        for failed in context.meta.get(FAILED, ())[:1]:
            raise failed
        if left is not None:
            raise left
        return answer

    return command


def _files(context: click.Context) -> dict[str, tuple[int, ...]]:
    """Files to write that are there, and what tells one from another."""
    there: dict[str, tuple[int, ...]] = {}
    for param in context.command.params:
        value = context.params.get(param.name or "")
        if isinstance(param.type, OutputFile) and value is not None:
            with suppress(OSError):
                stat = os.stat(value)
                there[value] = (stat.st_ino, stat.st_mtime_ns, stat.st_size)
    return there


def _kept(
    before: dict[str, tuple[int, ...]], now: dict[str, tuple[int, ...]]
) -> str:
    """What of the files was written, in words."""
    new = [file for file, stat in now.items() if before.get(file) != stat]
    return f"kept: {', '.join(new)}" if new else NOTHING


def _check(context: click.Context, overwrite: bool) -> None:
    """Refuse files of a command that it could not write, or only one of."""
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
                f"{name} must be another file than that of {other}, got "
                f"{value!r}"
            )


def attempt(write: Callable[[], Any]) -> bool:
    """Write what can be written; what cannot is told when all else is.

    Args:
        write: Writes it.

    Returns:
        Whether it is written.
    """
    try:
        write()
    except OutputError as error:
        context = click.get_current_context()
        context.meta.setdefault(FAILED, []).append(error)
        return False
    return True


__all__ = ["OutputFile", "attempt", "writes_files"]
