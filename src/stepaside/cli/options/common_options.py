"""Options of commands themselves, which no configuration holds."""

from collections.abc import Callable
from contextlib import nullcontext
from functools import wraps
from pathlib import Path
from typing import Any

import click

from ...core.atomic_output import FIGURES
from ...report.figure_sizes import SHEETS, figures_on
from ..value_types import NumberType, json_alone
from .declaration import OptionDeclaration
from .value_kinds import NameType, OutputFile

INTERRUPTED = 130  # exit status of a command that was stopped
JSON = OptionDeclaration(
    "--json/--no-json", "Print one JSON object.", more_names=("as_json",)
)


def json_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command ``--json``, with which it prints nothing else."""

    @wraps(function)
    def command(*words: Any, **values: Any) -> Any:
        with json_alone() if values["as_json"] else nullcontext():
            return function(*words, **values)

    return JSON.option(default=False)(command)


FOLDER = OptionDeclaration(
    "--output",
    "Folder of results.",
    kind=click.Path(file_okay=False, path_type=Path),
)
FILE = OptionDeclaration(
    "--output",
    "File to write.",
    kind=OutputFile(),
)
FIGURE = OptionDeclaration(
    "--figure",
    "Write a figure (.png, .svg or .pdf).",
    kind=OutputFile(*FIGURES),
)
WIDTH = OptionDeclaration(
    "--figure-width",
    "Of figures: as on a screen, or in the sizes and fonts of papers with "
    "two columns, across a page or in one column.",
    kind=NameType(lambda: SHEETS),
)
WORKERS = OptionDeclaration(
    "--workers",
    "Processes; all cores by default.",
    kind=click.IntRange(1, 1024),  # more only wait for each other
)
FIRST_SEED = OptionDeclaration(
    "--seed", "Of every random draw.", kind=click.IntRange(0, 2**128 - 1)
)
PORT = OptionDeclaration(
    "--port", "To serve the page at.", kind=click.IntRange(1, 65535)
)
BROWSER = OptionDeclaration(
    "--open/--no-open", "Open the page in a browser.", more_names=("opens",)
)
SERVE_FOR = OptionDeclaration(
    "--serve-for",
    "Stop serving after this time",
    unit="s",
    kind=NumberType("s"),
)
CAPTURE = OptionDeclaration(
    "--body",
    "Distance {unit} that counts as capture.",
    unit="m",
    kind=NumberType("m"),
)
GAME_TIME = OptionDeclaration(
    "--duration", "Length of a game", unit="s", kind=NumberType("s")
)
SAMPLE_TIME = OptionDeclaration(
    "--sample-time",
    "Time for which turning rates are held",
    unit="s",
    kind=NumberType("s", allow_zero=True),
)
DELAY = OptionDeclaration(
    "--delay",
    "Age of a perception when it takes effect",
    unit="s",
    kind=NumberType("s", allow_zero=True),
)


def _choose_sheet(
    context: click.Context, _: click.Parameter, name: str
) -> None:
    """Draw on a sheet until the command is through."""
    context.with_resource(figures_on(name))


figure_width = WIDTH.option(
    default="screen",
    show_default=True,
    callback=_choose_sheet,
    expose_value=False,
)
