"""``stepaside replay``: a run as a live page, an offline page or a video."""

import webbrowser
from collections.abc import Callable
from pathlib import Path
from time import sleep
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import FIGURES, reason_of
from ..core.errors import OutputError
from .effort_estimate import IMAGES, announce_effort
from .options.common_options import (
    browser_option,
    figure_width,
    json_option,
    port_option,
    serve_for_option,
)
from .options.parameter_types import POSITIVE, SECONDS, NameType, NumberType
from .options.setting_options import refuse_options
from .output_files import OutputFile, attempt, writes_files
from .progress import show_progress
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..games.run import Run
    from ..report.film import FilmSettings


FILM = (  # options of films
    *("begin", "duration", "rate", "speed", "width", "height", "camera"),
    *("slow", "captions", "title", "layers"),
)
PAGE = ("port", "opens", "serve_for")  # options of the live page


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
    help="Write a single page that opens offline.",
)
@click.option(
    "--video", type=OutputFile(".mp4"), help="Write a video (H.264)."
)
@click.option(
    "--gif", type=OutputFile(".gif"), help="Write a short animation."
)
@click.option(
    "--strip",
    type=OutputFile(*FIGURES),
    help="Write four frames of the run, each above its top view.",
)
@click.option(
    "--begin",
    type=NumberType("s", allow_zero=True),
    default=0.0,
    help="Start of the video in the run [s].",
)
@click.option(
    "--duration", type=SECONDS, help="Duration of the run in the video [s]."
)
@click.option(
    "--rate", type=NumberType("1/s"), help="Frame rate of the video [1/s]."
)
@click.option(
    "--speed",
    type=POSITIVE,
    default=1.0,
    help="Speed of the video [1]; 2 is twice real time.",
)
@click.option(
    "--width", type=click.IntRange(64, 3840), help="Image width in pixels."
)
@click.option(
    "--height", type=click.IntRange(64, 2160), help="Image height in pixels."
)
@click.option(
    "--camera",
    type=NameType(_views),
    default="fixed",
    show_default=True,
    help="View of the video: fixed view of the whole run, following the "
    "robots, top view, evader's camera, or following beside both robots' "
    "camera images.",
)
@click.option(
    "--slow-motion/--no-slow-motion",
    "slow",
    default=False,
    help="Slow the video down around the closest approach.",
)
@click.option(
    "--captions/--no-captions",
    default=True,
    help="Show players, time and distance in the video.",
)
@click.option("--title", default="", help="Title in the upper left corner.")
@click.option(
    "--layers/--no-layers",
    default=True,
    help="Draw trajectories and plans in the video.",
)
@figure_width
@port_option()
@browser_option()
@serve_for_option()
@json_option
@writes_files
def replay(run: Path, as_json: bool, **options: Any) -> None:
    """Replay the run in the folder RUN.

    By default, serves a page with a time slider. With --html, --video, --gif
    or --strip, writes files instead.
    """
    from ..games.run_archive import load_run

    films = [options[kind] for kind in ("video", "gif", "strip")]
    if films == [None, None, None]:
        refuse_options(FILM, "--video, --gif or --strip")
    if options["html"] or any(films):
        refuse_options(PAGE, "a live page, without output files")
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

        film = _film_settings(options, 60.0, 30.0, 1280, 720)
        _announce(film, loaded)
        _render("video", write_video, run, video, film, written)
    if gif is not None:
        from ..report.film import write_gif

        film = _film_settings(options, 12.0, 10.0, 480, 270)
        _announce(film, loaded)
        _render("gif", write_gif, run, gif, film, written)
    if strip is not None:
        from ..report.film_strip import write_strip

        film = _film_settings(options, 3600.0, 1.0, 640, 480)
        _render("strip", write_strip, run, strip, film, written)
    if html is video is gif is strip is None:
        _serve(loaded, options)
    elif as_json:
        print_json(written)
    else:
        for kind, entry in written.items():
            size = entry["bytes"] / 1e6
            echo(f"{kind}: {entry['file']} ({size:.1f} MB)")


def _written(file: Path) -> dict[str, Any]:
    """Return name and size of a written file.

    Raises:
        OutputError: If the file has been removed since.
    """
    try:
        return {"file": str(file), "bytes": file.stat().st_size}
    except OSError as error:
        raise OutputError(
            f"{file} was removed after it was written: {reason_of(error)}"
        ) from error


def _film_settings(
    options: dict[str, Any],
    duration: float,
    rate: float,
    width: int,
    height: int,
) -> Any:
    from ..report.film import FilmSettings

    wide, high = options["width"] or width, options["height"] or height
    return FilmSettings(
        # H.264 subsamples colour by two in both directions.
        width=wide - wide % 2,
        height=high - high % 2,
        rate=options["rate"] or rate,
        speed=options["speed"],
        begin=options["begin"],
        duration=options["duration"] or duration,
        camera=options["camera"],
        layers=options["layers"],
        slow=options["slow"],
        captions=options["captions"],
        title=options["title"],
    )


def _announce(film: "FilmSettings", run: "Run") -> None:
    """Announce long rendering."""
    from ..report.film_settings import AROUND, SLOWEST

    shown = min(float(run.times[-1]) - film.begin, film.duration)
    slower = 2.0 * AROUND / SLOWEST if film.slow else 0.0
    number = max(shown + slower, 0.0) * film.rate / film.speed
    size = film.width * film.height / (640 * 480)
    announce_effort(
        f"a video of about {number:.0f} frames",
        number * size / IMAGES,
        workers=None,
    )


def _render(
    name: str,
    write: Callable[..., int],
    run: Path,
    file: Path,
    film: Any,
    written: dict[str, Any],
) -> None:
    """Render a film with a progress bar, and add it to ``written``."""
    with show_progress(name, unit="frames") as bar:

        def report(done: int, number: int) -> None:
            bar.total, bar.n = number, done
            bar.refresh()

        def render() -> None:
            write(run, file, film, report)
            written[name] = _written(file) | {"pictures": bar.n}

        attempt(render)


def _serve(run: Any, options: dict[str, Any]) -> None:
    from ..report.viewer.replay_viewer import ReplayPage

    page = ReplayPage(run, port=options["port"])
    page.start()
    address = f"http://127.0.0.1:{page.server.get_port()}"
    echo(f"serving at {address}; press Ctrl-C to stop")
    if options["opens"]:
        webbrowser.open(address)
    try:
        while options["serve_for"] is None:
            sleep(1.0)
        sleep(options["serve_for"])
    except KeyboardInterrupt:
        echo("stepaside: stopped; the run is unchanged", err=True)
    finally:
        page.close()
