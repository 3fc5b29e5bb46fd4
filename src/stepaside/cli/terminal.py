"""Output of commands: text, JSON on standard output, interruptions."""

import json
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import (
    ExitStack,
    contextmanager,
    nullcontext,
    redirect_stdout,
)
from functools import wraps
from pathlib import Path
from typing import Any, NoReturn, TextIO

import click

from ..core.errors import visible
from ..core.signal_handling import interrupted_status

NOTHING_SAVED = "nothing is saved"
STDOUT, STDERR = 1, 2  # file descriptors


def echo(text: str = "", *, err: bool = False, nl: bool = True) -> None:
    r"""Print text with all control characters but ``\n`` and ``\t`` escaped.

    File names and entries of run folders may contain escape sequences that
    a terminal would execute.
    """
    click.echo(visible(text, but="\n\t"), err=err, nl=nl)


_reserved: list[TextIO] = []  # standard output while reserved for JSON


@contextmanager
def reserve_stdout() -> Iterator[None]:
    """Reserve standard output for :func:`print_json`.

    All other output, as of user strategies and of processes that they start,
    is redirected to standard error.
    """
    shared = sys.stdout
    with ExitStack() as stack:
        stream = shared
        if _descriptor(shared) == STDOUT:
            shared.flush()
            saved = os.dup(STDOUT)
            stack.callback(os.close, saved)
            stream = stack.enter_context(
                open(
                    os.dup(STDOUT),
                    "w",
                    encoding=shared.encoding,
                    errors=shared.errors,
                )
            )
            stack.callback(os.dup2, saved, STDOUT)
            stack.callback(shared.flush)
            os.dup2(_duplicate_stderr(stack), STDOUT)
        stack.enter_context(redirect_stdout(sys.stderr))
        _reserved.append(stream)
        stack.callback(_reserved.pop)
        yield


def _descriptor(stream: TextIO) -> int | None:
    try:
        return stream.fileno()
    except (OSError, ValueError):  # a stream without descriptor
        return None


def _duplicate_stderr(stack: ExitStack) -> int:
    """Duplicate standard error; open the null device if it is closed."""
    try:
        descriptor = os.dup(STDERR)
    except OSError:
        descriptor = os.open(os.devnull, os.O_WRONLY)
    stack.callback(os.close, descriptor)
    return descriptor


def print_json(value: Any) -> None:
    """Print a value as one JSON object."""
    write_result(json.dumps(value, allow_nan=False) + "\n")


def write_result(text: str) -> None:
    """Write a result to standard output, even while that is reserved."""
    with redirect_stdout(_reserved[-1]) if _reserved else nullcontext():
        echo(text, nl=False)


def exit_interrupted(message: str) -> NoReturn:
    """Report what is saved, and exit with the status of its signal."""
    echo(f"stepaside: interrupted; {message}", err=True)
    raise SystemExit(interrupted_status())


def resume_message(done: str, path: Path | None) -> str:
    """Return a sentence about the saved part of a campaign.

    It is ``done``, like ``3 of 10 duels``, and recorded at a path, if any.
    """
    if path is None:
        return f"{done} finished; {NOTHING_SAVED} without --output"
    return f"{done} are saved in {path}; run the same command to continue"


def json_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add ``--json``, which reserves standard output for one JSON object."""

    @wraps(function)
    def command(*args: Any, **values: Any) -> Any:
        with reserve_stdout() if values["as_json"] else nullcontext():
            return function(*args, **values)

    return click.option(
        "--json", "as_json", is_flag=True, help="Print one JSON object."
    )(command)
