"""``stepaside replay``: a run again, as a page, a file or a film."""

import webbrowser
from collections.abc import Callable
from pathlib import Path
from time import sleep
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import FIGURES, reason_of
from ..core.errors import OutputError
from .effort_estimate import PICTURES, tell_effort
from .options.common_options import (
    BROWSER,
    PORT,
    SERVE_FOR,
    figure_width,
    json_option,
)
from .options.value_kinds import NameType
from .output_files import OutputFile, attempt, writes_files
from .progress import show_progress
from .terminal import echo
from .value_types import POSITIVE, SECONDS, NumberType, print_json

if TYPE_CHECKING:
    from ..games.run import Run
    from ..report.film import FilmSettings

FORMER = {"following": "follow"}  # names of today by former ones


def _views() -> tuple[str, ...]:
    from ..report.film_camera import VIEWS

    return VIEWS


@click.command("replay")
@click.argument(
    "run", type=click.Path(exists=True, file_okay=False, path_type=Path)
)
@click.option(
    "--html",
    type=OutputFile(".html", ".htm"),
    help="Write one page that opens offline.",
)
@click.option("--video", type=OutputFile(".mp4"), help="Write a film (H.264).")
@click.option("--gif", type=OutputFile(".gif"), help="Write a short film.")
@click.option(
    "--strip",
    type=OutputFile(*FIGURES),
    help="Write four pictures of a film, each over its view from above.",
)
@click.option(
    "--begin",
    type=NumberType("s", allow_zero=True),
    default=0.0,
    help="Of a film, in the run [s].",
)
@click.option("--duration", type=SECONDS, help="Of the run in a film [s].")
@click.option(
    "--rate", type=NumberType("1/s"), help="Pictures a second [1/s]."
)
@click.option(
    "--speed",
    type=POSITIVE,
    default=1.0,
    help="Of a film [1]; 2 is twice as fast.",
)
@click.option("--width", type=click.IntRange(64, 3840), help="Of a picture.")
@click.option("--height", type=click.IntRange(64, 2160), help="Likewise.")
@click.option(
    "--camera",
    type=NameType(_views, FORMER),
    default="fixed",
    show_default=True,
    help="It stands and sees all, goes along, looks from above, through the "
    "evader's eyes, or goes along beside what the robots see.",
)
@click.option(
    "--slow-motion/--no-slow-motion",
    "slow",
    default=False,
    help="A film lasts longer about the closest approach.",
)
@click.option(
    "--words/--no-words",
    default=True,
    help="A film says who is who, the time and the distance.",
)
@click.option("--title", default="", help="In a film's upper left corner.")
@click.option("--layers/--no-layers", default=True, help="Lines in a film.")
@figure_width
@PORT.option(default=8080, show_default=True)
@BROWSER.option(default=True)
@SERVE_FOR.option()
@json_option
@writes_files
def replay(run: Path, as_json: bool, **options: Any) -> None:
    """Show the duel of a RUN folder again.

    With no file asked for, it is served as a page with a time slider.
    """
    from ..games.run_archive import load_run

    loaded = load_run(run)
    written: dict[str, Any] = {}
    html, video, gif, strip = (
        None if options[kind] is None else Path(options[kind])
        for kind in ("html", "video", "gif", "strip")
    )
    if html is not None:
        from ..report.replay_page import write_page

        def page() -> None:
            write_page(loaded, html)
            written["html"] = _written(html)

        attempt(page)
    if video is not None:
        from ..report.film import write_video

        shot = _shot(options, 60.0, 30.0, 1280, 720)
        _tell(shot, loaded)
        _film("video", write_video, run, video, shot, written)
    if gif is not None:
        from ..report.film import write_gif

        shot = _shot(options, 12.0, 10.0, 480, 270)
        _tell(shot, loaded)
        _film("gif", write_gif, run, gif, shot, written)
    if strip is not None:
        from ..report.film_strip import write_strip

        shot = _shot(options, 3600.0, 1.0, 640, 480)
        _film("strip", write_strip, run, strip, shot, written)
    if html is video is gif is strip is None:
        _serve(loaded, options)
    elif as_json:
        print_json(written)
    else:
        for kind, entry in written.items():
            size = entry["bytes"] / 1e6
            echo(f"{kind}: {entry['file']} ({size:.1f} MB)")


def _written(file: Path) -> dict[str, Any]:
    """Name and size of a file that was written.

    Raises:
        OutputError: If somebody removed it since.
    """
    try:
        return {"file": str(file), "bytes": file.stat().st_size}
    except OSError as error:
        raise OutputError(
            f"{file} is not there any more: {reason_of(error)}"
        ) from error


def _shot(
    options: dict[str, Any],
    duration: float,
    rate: float,
    width: int,
    height: int,
) -> Any:
    from ..report.film import FilmSettings

    wide, high = options["width"] or width, options["height"] or height
    return FilmSettings(
        # H.264 stores colour for two by two pixels.
        width=wide - wide % 2,
        height=high - high % 2,
        rate=options["rate"] or rate,
        speed=options["speed"],
        begin=options["begin"],
        duration=options["duration"] or duration,
        camera=options["camera"],
        layers=options["layers"],
        slow=options["slow"],
        words=options["words"],
        title=options["title"],
    )


def _tell(shot: "FilmSettings", run: "Run") -> None:
    """Say how long a film takes."""
    from ..report.film_shot import AROUND, SLOWEST

    shown = min(float(run.times[-1]) - shot.begin, shot.duration)
    slower = 2.0 * AROUND / SLOWEST if shot.slow else 0.0
    number = max(shown + slower, 0.0) * shot.rate / shot.speed
    size = shot.width * shot.height / (640 * 480)
    tell_effort(
        f"a film of about {number:.0f} pictures",
        number * size / PICTURES,
        workers=None,
    )


def _film(
    name: str,
    write: Callable[..., int],
    run: Path,
    file: Path,
    shot: Any,
    written: dict[str, Any],
) -> None:
    """Write a film with a bar, and note it."""
    with show_progress(name, unit="pictures") as bar:

        def report(done: int, number: int) -> None:
            bar.total, bar.n = number, done
            bar.refresh()

        def film() -> None:
            write(run, file, shot, report)
            written[name] = _written(file) | {"pictures": bar.n}

        attempt(film)


def _serve(run: Any, options: dict[str, Any]) -> None:
    from ..report.viewer.replay_viewer import ReplayPage

    page = ReplayPage(run, port=options["port"])
    page.start()
    address = f"http://127.0.0.1:{page.server.get_port()}"
    echo(f"serving at {address}; Ctrl-C stops")
    if options["opens"]:
        webbrowser.open(address)
    try:
        while options["serve_for"] is None:
            sleep(1.0)
        sleep(options["serve_for"])
    except KeyboardInterrupt:
        echo("stepaside: stopped; the run is as it was", err=True)
    finally:
        page.close()
