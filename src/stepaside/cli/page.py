"""``stepaside page``: a page on which a duel is played in the browser."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .options.duel_options import page_options
from .options.settings_command import SettingsCommand
from .terminal import echo

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings


@click.command("page", cls=SettingsCommand)
@click.argument("output", type=click.Path(file_okay=False, path_type=Path))
@click.option(
    "--engine",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Package of MuJoCo's WebAssembly build, as npm pack leaves it; by "
    "default npm fetches it.",
)
@click.option(
    "--runtime",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Package of ONNX Runtime for the web, which robots on learned legs "
    "need; by default npm fetches it.",
)
@page_options()
def page(
    settings: "DuelSettings",
    output: Path,
    engine: Path | None,
    runtime: Path | None,
) -> None:
    """Write a folder OUTPUT with a page that plays the duel in a browser.

    MuJoCo runs in the browser, with control and strategies of this package
    as JavaScript. Any web server can serve the folder. The visitor chooses
    the network of robots on learned legs; it is not written.
    """
    from ..report.game_page import write_game_page

    write_game_page(settings, output, engine, runtime)
    files = [file for file in output.iterdir() if file.is_file()]
    size = sum(file.stat().st_size for file in files) / 1e6
    echo(
        f"wrote {output}, {size:.1f} MB; serve it with: "
        f"python -m http.server --directory {output}"
    )
