"""``stepaside view``: an interactive game in the browser."""

import webbrowser
from contextlib import closing
from pathlib import Path
from time import sleep
from typing import TYPE_CHECKING, Any, NamedTuple

import click
from click.core import ParameterSource

from ..games.duel_settings import DuelSettings
from .options.common_options import (
    browser_option,
    port_option,
    serve_for_option,
)
from .options.settings_options import DUEL, takes_settings
from .terminal import echo

if TYPE_CHECKING:
    from ..games.game_settings import GameSettings
    from ..report.viewer.live_page import Page


class ViewOptions(NamedTuple):
    """Options of the command besides the settings of a duel.

    Attributes:
        file: Game file; None for a duel.
        port: First port to try.
        opens: Whether to open a browser.
        run: Whether the simulation starts at once.
        serve_for: Time after which to stop, in [s]; None for no limit.
    """

    file: Path | None
    port: int
    opens: bool
    run: bool
    serve_for: float | None


OWN = {*ViewOptions._fields, "seed"}


@click.command("view")
@click.argument(
    "file",
    required=False,
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
)
@port_option()
@browser_option()
@click.option(
    "--run/--no-run",
    default=True,
    show_default=True,
    help="Start the simulation immediately, or paused.",
)
@serve_for_option("--duration")
@takes_settings(DuelSettings, DUEL, without=("duration",))
def view(settings: DuelSettings, **options: Any) -> None:
    """Serve a page on which to watch a game, push and drive the robots.

    With FILE it is the game in physics of any number of players that FILE
    lists (docs/games.md), of which --seed is the only option; otherwise a
    duel.
    """
    given = ViewOptions(**options)
    played: DuelSettings | GameSettings = settings
    if given.file is not None:
        played = _game_of(given.file)
    from ..report.viewer.live_page import Page

    page = Page(played, port=given.port)
    with closing(page):
        page.session.running = given.run
        _serve(page, given)


def _serve(page: "Page", options: ViewOptions) -> None:
    """Serve a page until it is interrupted."""
    from ..report.viewer.page_server import address_of

    page.start()
    address = address_of(page.server)
    echo(f"serving at {address}; press Ctrl-C to stop")
    if options.opens:
        webbrowser.open(address)
    try:
        if options.serve_for is None:
            while True:
                sleep(1.0)
        sleep(options.serve_for)
    except KeyboardInterrupt:
        echo("stepaside: stopped; saved runs remain", err=True)


def _game_of(file: Path) -> "GameSettings":
    """Return the game of a file, with the seed of the command line.

    Raises:
        UsageError: If there are options of a duel.
    """
    from ..games.game_file import load_game

    context = click.get_current_context()
    given = {
        param.name: param.opts[0]
        for param in context.command.params
        if context.get_parameter_source(param.name or "")
        is ParameterSource.COMMANDLINE
    }
    foreign = [flag for name, flag in given.items() if name not in OWN]
    if foreign:
        raise click.UsageError(
            f"{', '.join(foreign)} must not be given with a game file, which "
            "has the settings of its players"
        )
    seed = context.params["seed"]
    return load_game(file, **({"seed": seed} if "seed" in given else {}))
