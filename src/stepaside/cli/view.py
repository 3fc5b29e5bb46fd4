"""``stepaside view``: a duel to watch, push and drive in a browser."""

import webbrowser
from time import sleep
from typing import TYPE_CHECKING

import click

from .duel_options import duel_options
from .options.common_options import BROWSER, PORT, SERVE_FOR
from .options.declaration import OptionDeclaration
from .options.game_options import DURATION
from .options.settings_command import SettingsCommand
from .terminal import echo

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings

HOST = OptionDeclaration(
    "--host",
    "Address to serve at; where other machines reach it, the link holds a "
    "secret.",
)
RUNNING = OptionDeclaration("--run/--no-run", "Let time pass at once.")


@click.command("view", cls=SettingsCommand)
@HOST.option(default="127.0.0.1", show_default=True)
@PORT.option(default=8080, show_default=True)
@BROWSER.option(default=True)
@RUNNING.option(default=True, show_default=True)
@SERVE_FOR.option(more_names=("--duration",))
@duel_options(DURATION)
def view(
    settings: "DuelSettings",
    host: str,
    port: int,
    opens: bool,
    run: bool,
    serve_for: float | None,
) -> None:
    """Serve a page with two robots that chase each other."""
    from ..report.viewer.live_page import Page

    page = Page(settings, host=host, port=port)
    if page.gate.secret:
        echo(
            f"stepaside: {host} can be reached from other machines, and "
            "whoever has the link can drive the robots",
            err=True,
        )
    page.session.running = run
    page.start()
    address = page.gate.link
    echo(f"serving at {address}; Ctrl-C stops")
    if opens:
        webbrowser.open(address)
    try:
        if serve_for is None:
            while True:
                sleep(1.0)
        sleep(serve_for)
    except KeyboardInterrupt:
        echo("stepaside: stopped; what was saved is kept", err=True)
    finally:
        page.close()
