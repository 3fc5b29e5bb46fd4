"""``stepaside view``: an interactive duel in the browser."""

import webbrowser
from time import sleep
from typing import TYPE_CHECKING

import click

from .options.common_options import (
    browser_option,
    port_option,
    serve_for_option,
)
from .options.duel_options import duel_options
from .options.settings_command import SettingsCommand
from .terminal import echo

if TYPE_CHECKING:
    from ..games.duel_settings import DuelSettings


@click.command("view", cls=SettingsCommand)
@click.option(
    "--host",
    default="127.0.0.1",
    show_default=True,
    help="Address of the server. If other machines can reach it, the link "
    "contains a secret.",
)
@port_option()
@browser_option()
@click.option(
    "--run/--no-run",
    default=True,
    show_default=True,
    help="Start the simulation immediately, or paused.",
)
@click.option(
    "--demo/--no-demo",
    help="Show large text and no controls, and play one duel after the other "
    "with the next seeds, for an audience.",
)
@serve_for_option("--duration")
@duel_options("duration")
def view(
    settings: "DuelSettings",
    host: str,
    port: int,
    opens: bool,
    run: bool,
    demo: bool,
    serve_for: float | None,
) -> None:
    """Serve a page on which to watch a duel, push and drive the robots."""
    from ..report.viewer.live_page import Page

    page = Page(settings, host=host, port=port, demo=demo)
    if page.gate.secret:
        echo(
            f"stepaside: other machines can reach {host}; anyone with the "
            "link can drive the robots",
            err=True,
        )
    page.session.running = run
    page.start()
    address = page.gate.link
    echo(f"serving at {address}; press Ctrl-C to stop")
    if opens:
        webbrowser.open(address)
    try:
        if serve_for is None:
            while True:
                sleep(1.0)
        sleep(serve_for)
    except KeyboardInterrupt:
        echo("stepaside: stopped; saved runs remain", err=True)
    finally:
        page.close()
