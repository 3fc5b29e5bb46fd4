"""Options of commands that are not part of any configuration."""

from collections.abc import Callable
from contextlib import nullcontext
from functools import wraps
from pathlib import Path
from typing import Any

import click

from ...core.atomic_output import FIGURES
from ...report.figure_sizes import SHEETS, figures_on
from ..value_types import NumberType, reserve_stdout
from .declaration import OptionDeclaration
from .value_kinds import NameType, OutputFile

INTERRUPTED = 130  # exit status of an interrupted command
JSON = OptionDeclaration(
    "--json/--no-json", "Print one JSON object.", aliases=("as_json",)
)


def json_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add ``--json``, which reserves standard output for one JSON object."""

    @wraps(function)
    def command(*args: Any, **values: Any) -> Any:
        with reserve_stdout() if values["as_json"] else nullcontext():
            return function(*args, **values)

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
    "Figure size and fonts: for a screen, or for the page or one column of a "
    "two-column paper.",
    kind=NameType(lambda: SHEETS),
)
WORKERS = OptionDeclaration(
    "--workers",
    "Number of worker processes; one per core by default.",
    kind=click.IntRange(1, 1024),  # more than any machine has cores
)
FIRST_SEED = OptionDeclaration(
    "--seed", "Random seed.", kind=click.IntRange(0, 2**128 - 1)
)
PORT = OptionDeclaration(
    "--port", "TCP port of the page.", kind=click.IntRange(1, 65535)
)
BROWSER = OptionDeclaration(
    "--open/--no-open", "Open the page in a browser.", aliases=("opens",)
)
SERVE_FOR = OptionDeclaration(
    "--serve-for",
    "Stop the server after this time",
    unit="s",
    kind=NumberType("s"),
)
CAPTURE = OptionDeclaration(
    "--body",
    "Capture distance",
    unit="m",
    kind=NumberType("m"),
)
GAME_TIME = OptionDeclaration(
    "--duration", "Duration of a game", unit="s", kind=NumberType("s")
)
SAMPLE_TIME = OptionDeclaration(
    "--sample-time",
    "Sampling period; turning rates are held constant in between",
    unit="s",
    kind=NumberType("s", allow_zero=True),
)
DELAY = OptionDeclaration(
    "--delay",
    "Delay from sensing to turning",
    unit="s",
    kind=NumberType("s", allow_zero=True),
)


def _choose_sheet(
    context: click.Context, _: click.Parameter, name: str
) -> None:
    """Set the figure size until the command ends."""
    context.with_resource(figures_on(name))


figure_width = WIDTH.option(
    default="screen",
    show_default=True,
    callback=_choose_sheet,
    expose_value=False,
)
