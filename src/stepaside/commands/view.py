"""``stepaside view``: a duel to watch, push and drive in a browser."""

import webbrowser
from time import sleep
from typing import TYPE_CHECKING

import click

from .declared.common import BROWSER, PORT, SERVE_FOR
from .declared.game import DURATION
from .declared.option import Declaration
from .declared.take import SettingsCommand
from .duel_options import duel_options

if TYPE_CHECKING:
    from ..games.settings import DuelSettings

LOCAL = ("127.0.0.1", "localhost", "::1")
HOST = Declaration(
    "--host",
    "Address to serve at; others than this machine's are open to all.",
)
RUNNING = Declaration("--run/--no-run", "Let time pass at once.")


@click.command("view", cls=SettingsCommand)
@HOST.option(default="127.0.0.1", show_default=True)
@PORT.option(default=8080, show_default=True)
@BROWSER.option(default=True)
@RUNNING.option(default=False)
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
    from ..report.viewer.page import Page

    if host not in LOCAL:
        click.echo(
            f"stepaside: {host} can be reached from other machines, and "
            "whoever opens the page can drive the robots",
            err=True,
        )
    page = Page(settings, host=host, port=port)
    page.session.running = run
    page.start()
    address = f"http://{host}:{page.server.get_port()}"
    click.echo(f"serving at {address}; Ctrl-C stops")
    if opens:
        webbrowser.open(address)
    try:
        if serve_for is None:
            while True:
                sleep(1.0)
        sleep(serve_for)
    except KeyboardInterrupt:
        pass
    finally:
        page.close()
