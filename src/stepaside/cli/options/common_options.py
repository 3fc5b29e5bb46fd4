"""Options that several commands share, outside any configuration."""

from collections.abc import Callable
from contextlib import nullcontext
from functools import partial, wraps
from pathlib import Path
from typing import Any

import click

from ...core.atomic_output import FIGURES
from ...report.figure_sizes import SHEETS, figures_on
from ..terminal import reserve_stdout
from .parameter_types import NameType, NumberType, OutputFile


def json_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add ``--json``, which reserves standard output for one JSON object."""

    @wraps(function)
    def command(*args: Any, **values: Any) -> Any:
        with reserve_stdout() if values["as_json"] else nullcontext():
            return function(*args, **values)

    return click.option(
        "--json/--no-json",
        "as_json",
        default=False,
        help="Print one JSON object.",
    )(command)


folder_option = partial(
    click.option,
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder of results.",
)
figure_option = partial(
    click.option,
    "--figure",
    type=OutputFile(*FIGURES),
    help="Write a figure (.png, .svg or .pdf).",
)
workers_option = partial(
    click.option,
    "--workers",
    type=click.IntRange(1, 1024),  # more than any machine has cores
    help="Number of worker processes; one per core by default.",
)
seed_option = partial(
    click.option,
    "--seed",
    type=click.IntRange(0, 2**128 - 1),
    help="Random seed.",
)
port_option = partial(
    click.option,
    "--port",
    type=click.IntRange(1, 65535),
    default=8080,
    show_default=True,
    help="TCP port of the page.",
)
browser_option = partial(
    click.option,
    "--open/--no-open",
    "opens",
    default=True,
    help="Open the page in a browser.",
)
serve_for_option = partial(
    click.option,
    "--serve-for",
    type=NumberType("s"),
    help="Stop the server after this time [s].",
)
capture_option = partial(
    click.option,
    "--body",
    type=NumberType("m"),
    help="Capture distance [m].",
)
game_time_option = partial(
    click.option,
    "--duration",
    type=NumberType("s"),
    help="Duration of a game [s].",
)
sample_time_option = partial(
    click.option,
    "--sample-time",
    type=NumberType("s", allow_zero=True),
    default=0.0,
    show_default=True,
    help="Sampling period; turning rates are held constant in between [s].",
)
delay_option = partial(
    click.option,
    "--delay",
    type=NumberType("s", allow_zero=True),
    default=0.0,
    show_default=True,
    help="Delay from sensing to turning [s].",
)
domain_option = partial(
    click.option,
    "--domain",
    type=click.IntRange(0, 232),
    help="ROS 2 domain; ROS_DOMAIN_ID by default, or 0 if that is not set.",
)
network_option = partial(
    click.option,
    "--network/--no-network",
    default=False,
    help="Make the ROS 2 topics visible to other machines. Without it, ROS 2 "
    "programs on this machine require "
    "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST.",
)


def _choose_sheet(
    context: click.Context, _: click.Parameter, name: str
) -> None:
    """Set the figure size until the command ends."""
    context.with_resource(figures_on(name))


figure_width = click.option(
    "--figure-width",
    type=NameType(lambda: SHEETS),
    default="screen",
    show_default=True,
    callback=_choose_sheet,
    expose_value=False,
    help="Figure size and fonts: for a screen, or for the page or one column "
    "of a two-column paper.",
)
