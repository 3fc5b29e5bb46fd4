"""Options that several commands share."""

import os
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import click

from ..core.atomic_output import FIGURES, check_file
from ..core.errors import StepAsideError, nearest_hint
from ..core.setting import similar_paths


class TextType(click.ParamType[Any]):
    """Type of an option that a function parses."""

    def __init__(self, name: str, parse: Callable[[str], Any]) -> None:
        """Wrap a function, which raises an error of this package."""
        self.name, self._parse = name, parse

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """Parse the value of an option; a default stays."""
        try:
            return self._parse(value) if isinstance(value, str) else value
        except StepAsideError as error:
            self.fail(str(error), param, ctx)


class ExistingPath(click.Path):
    """Type of an existing file or folder."""

    def __init__(self, **values: Any) -> None:
        """Require that it exists."""
        super().__init__(exists=True, path_type=Path, **values)

    def convert(
        self,
        value: Any,
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """Check a path; name what is nearest to the part that is missing."""
        missing = Path(value)
        if missing.name and not missing.exists():
            while not missing.parent.is_dir():
                missing = missing.parent
            names = os.listdir(missing.parent)
            hint = nearest_hint(missing.name, names)
            self.fail(f"there is no {self.name} {value}{hint}", param, ctx)
        return super().convert(value, param, ctx)


EXISTING = ExistingPath()
EXISTING_FILE = ExistingPath(dir_okay=False)
EXISTING_FOLDER = ExistingPath(file_okay=False)


def output_file(option: str, *suffixes: str) -> TextType:
    """Return the type of an output file, which is replaced if it exists.

    A name without suffix gets the first of the suffixes.
    """

    def parse(value: str) -> Path:
        file = Path(value)
        if file.name and not file.suffix:
            file = Path(f"{value}{suffixes[0]}")
        check_file(file, option, suffixes=suffixes, overwrite=True)
        return file

    return TextType("FILE", parse)


def figure_option(
    flag: str = "--figure", help: str = "Write a figure (.png, .svg or .pdf)."
) -> Callable[..., Any]:
    """Return an option for the file of a figure."""
    return click.option(flag, type=output_file(flag, *FIGURES), help=help)


folder_option = partial(
    click.option,
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    help="Run folder; a new one in runs/ by default, none with --json.",
)
file_argument = partial(click.argument, type=EXISTING_FILE)
seed_option = partial(
    click.option,
    "--seed",
    type=click.IntRange(0, 2**128 - 1),
    default=1,
    show_default=True,
    help="Random seed.",
)
browser_option = click.option(
    "--open/--no-open",
    "opens",
    default=True,
    help="Open the page in a browser.",
)
workers_option = click.option(
    "--workers",
    type=click.IntRange(1, 1024),  # more than any machine has cores
    help="Number of worker processes; one per core by default.",
)


def _shard(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text.strip())
    if found is None or not 1 <= int(found[1]) <= int(found[2]):
        raise click.BadParameter(
            f"must be I/N with integers 1 <= I <= N like 1/4, got {text!r}"
        )
    return int(found[1]), int(found[2])


shard_option = click.option(
    "--shard",
    type=TextType("I/N", _shard),
    default=(1, 1),
    help="Run every N-th case only, from the I-th.",
)


def tell_no_option(error: click.NoSuchOption) -> str:
    """Return the message; that of a setting without an option names it."""
    command = error.ctx.command if error.ctx else None
    entries = getattr(command and command.callback, "entries", ())
    name = error.option_name.lstrip("-").replace("-", "_")
    found = [
        f"--set {path}=VALUE"
        for path in similar_paths(entries, name)
        if path.rpartition(".")[2] == name
    ]
    if not found:
        return error.format_message()
    return f"no such option {error.option_name}; use {' or '.join(found)}"
