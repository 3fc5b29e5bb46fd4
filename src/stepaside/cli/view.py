"""``stepaside view``: an interactive game in the browser."""

import webbrowser
from contextlib import closing
from pathlib import Path
from time import sleep
from typing import Any

import click

from ..games.game_settings import GameSettings
from ..games.game_settings import duel as make_duel
from .duel import NAMED as NAMED_OF_DUEL
from .options import browser_option, file_argument
from .settings import refuse_settings, takes_settings
from .terminal import echo

# A live game has no end by time.
NAMED = tuple(name for name in NAMED_OF_DUEL if name != "duration")


@click.command("view")
@file_argument("file", required=False)
@takes_settings(NAMED, make_duel())
@click.option(
    "--port",
    type=click.IntRange(1, 65535),
    default=8080,
    show_default=True,
    help="First TCP port of the page to try.",
)
@browser_option
@click.option(
    "--run/--no-run",
    default=True,
    help="Start the simulation immediately, or paused.",
)
def view(
    settings: GameSettings,
    file: Path | None,
    port: int,
    opens: bool,
    run: bool,
) -> None:
    """Serve a page on which to watch a game, push and drive the robots.

    With FILE it is the game in physics of the players that FILE lists;
    otherwise a duel.
    """
    if file is not None:
        from ..games.settings_reader import load_game

        refuse_settings(("",), "a duel: FILE has the settings of its players")
        settings = load_game(file)
    from ..report.viewer.live_page import Page
    from ..report.viewer.page_server import address_of

    try:
        page: Any = Page(settings, port=port)
        with closing(page):
            page.session.running = run
            page.start()
            address = address_of(page.server)
            echo(f"serving at {address}; press Ctrl-C to stop")
            if opens:
                webbrowser.open(address)
            while True:
                sleep(1.0)
    except KeyboardInterrupt:
        echo("stepaside: stopped; saved runs remain", err=True)
