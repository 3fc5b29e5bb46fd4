"""``stepaside replay``: a run as an offline page or a video."""

import webbrowser
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import reason_of
from ..core.errors import OutputError
from ..report.film_settings import FilmSettings
from .bag_replay import ONLY_BAGS, BagOutputs, is_bag, replay_bag
from .options.common_options import (
    browser_option,
    figure_option,
    figure_width,
    json_option,
)
from .options.settings_options import refuse_options, takes
from .output_files import OutputFile, attempt, writes_files
from .progress import IMAGES, announce_effort, show_progress
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..games.run import Run


FILMS = {
    "video": FilmSettings(),
    "gif": FilmSettings(480, 270, rate=10.0, duration=12.0),
}


@click.command("replay")
@click.argument("run", type=click.Path(exists=True, path_type=Path))
@click.option(
    "--frame",
    "frames",
    multiple=True,
    metavar="NAME=FRAME",
    help="Of a bag: frame of tf, or topic (/odom), of a player; one option "
    "for each.",
)
@click.option(
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    help="Of a bag: run folder to create.",
)
@figure_option(help="Of a bag: write a figure (.png, .svg or .pdf).")
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
@takes(FilmSettings, "film", build=dict)
@figure_width
@browser_option()
@json_option
@writes_files
def replay(
    run: Path,
    html: str | None,
    video: str | None,
    gif: str | None,
    film: dict[str, Any],
    as_json: bool,
    frames: tuple[str, ...],
    output: Path | None,
    figure: str | None,
    opens: bool,
) -> None:
    """Replay the run in the folder RUN, or measure a ROS 2 bag.

    By default, writes a page with a time slider to a temporary folder and
    opens it. With --html, --video or --gif, writes files instead. Where RUN
    is a bag (a folder with metadata.yaml, a .mcap or a .db3 file), measures
    players whose motion was recorded elsewhere, as --frame names them.
    """
    from ..games.run_archive import load_run

    if is_bag(run):
        outputs = BagOutputs(html, figure, output)
        replay_bag(run, frames, outputs, as_json=as_json)
        return
    refuse_options(ONLY_BAGS, "a ROS 2 bag")
    if not (video or gif):
        names = {field.name for field in fields(FilmSettings)}
        refuse_options(names, "--video or --gif")
    loaded = load_run(run)
    shows = not (html or video or gif)
    if shows:
        html = str(Path(mkdtemp(prefix="stepaside-")) / f"{loaded.name}.html")
    else:
        refuse_options(("opens",), "a page without output files")
    written: dict[str, dict[str, Any]] = {}
    if html is not None:
        from ..report.replay_page import write_page

        def write() -> None:
            write_page(loaded, Path(html))
            written["html"] = _written(Path(html))

        attempt(write)
    for kind, file in (("video", video), ("gif", gif)):
        if file is not None:
            chosen = _even(replace(FILMS[kind], **film))
            _announce(chosen, loaded)
            _render(kind, run, Path(file), chosen, written)
    if shows and opens and html is not None:
        webbrowser.open(Path(html).as_uri())
    if as_json:
        print_json(written)
    else:
        for kind, entry in written.items():
            size = entry["bytes"] / 1e6
            echo(f"{kind}: {entry['file']} ({size:.1f} MB)")


def _even(film: FilmSettings) -> FilmSettings:
    """Return settings with even sides: H.264 halves the colour's."""
    return replace(
        film,
        width=film.width - film.width % 2,
        height=film.height - film.height % 2,
    )


def _writer(kind: str) -> Callable[..., int]:
    from ..report.film import write_gif, write_video

    return write_video if kind == "video" else write_gif


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


def _announce(film: FilmSettings, run: "Run") -> None:
    """Announce long rendering."""
    shown = min(float(run.times[-1]) - film.begin, film.duration)
    number = max(shown, 0.0) * film.rate / film.speed
    size = film.width * film.height / (640 * 480)
    announce_effort(
        f"a video of about {number:.0f} frames",
        number * size / IMAGES,
        workers=None,
    )


def _render(
    name: str,
    run: Path,
    file: Path,
    film: FilmSettings,
    written: dict[str, dict[str, Any]],
) -> None:
    """Render a film with a progress bar, and add it to ``written``."""
    write = _writer(name)
    with show_progress(name, unit="frames") as bar:

        def report(done: int, number: int) -> None:
            bar.total, bar.n = number, done
            bar.refresh()

        def render() -> None:
            write(run, file, film, report)
            written[name] = _written(file) | {"pictures": bar.n}

        attempt(render)
