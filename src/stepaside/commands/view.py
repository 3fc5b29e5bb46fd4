"""``stepaside view``: a duel to watch, push and drive in a browser."""

import webbrowser
from pathlib import Path
from time import sleep

import click

from .options import SECONDS

LOCAL = ("127.0.0.1", "localhost", "::1")


@click.command("view")
@click.option(
    "--host",
    default="127.0.0.1",
    show_default=True,
    help="Address to serve at; others than this machine's are open to all.",
)
@click.option(
    "--port", type=click.IntRange(1, 65535), default=8080, show_default=True
)
@click.option("--open/--no-open", "opens", default=True, help="A browser.")
@click.option("--seed", type=click.IntRange(0), help="Of every random draw.")
@click.option(
    "--sensing",
    type=click.Choice(["ideal", "cameras"]),
    help="Whether they are told where the other is, or see it.",
)
@click.option("--run", is_flag=True, help="Let time pass at once.")
@click.option(
    "--duration", type=SECONDS, help="Stop serving after this time [s]."
)
@click.option(
    "--config",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Configuration file of a duel.",
)
def view(
    host: str,
    port: int,
    opens: bool,
    seed: int | None,
    sensing: str | None,
    run: bool,
    duration: float | None,
    config: Path | None,
) -> None:
    """Serve a page with two robots that chase each other."""
    from dataclasses import replace

    from ..games.configuration import load_configuration
    from ..games.settings import DuelSettings
    from ..report.viewer.page import Page

    settings = DuelSettings() if config is None else load_configuration(config)
    if seed is not None:
        settings = replace(settings, seed=seed)
    if sensing is not None:
        settings = replace(settings, sensing=sensing)
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
        if duration is None:
            while True:
                sleep(1.0)
        sleep(duration)
    except KeyboardInterrupt:
        pass
    finally:
        page.close()
