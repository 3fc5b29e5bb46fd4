"""``stepaside show``: runs as pages, films, figures, tables and bags."""

import webbrowser
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import (
    FIGURES,
    check_file,
    check_folder,
    folder_draft,
)
from ..core.errors import ConfigurationError, OutputError, visible
from ..core.progress import ProgressLine
from ..report.film_settings import FilmSettings
from ..report.result_labels import label_of
from .options import EXISTING, browser_option
from .settings import GIVEN, refuse_settings, takes_settings
from .tables import format_value, print_columns, print_run
from .terminal import (
    NOTHING_SAVED,
    echo,
    exit_interrupted,
    json_option,
    print_json,
)

if TYPE_CHECKING:
    from ..games.game import Progress
    from ..games.run import Run

PAGES, FILMS = (".html", ".htm"), (".mp4", ".gif")
# With the library that writes each, if that needs one.
FORMATS = {".mcap": "rosbags", ".csv": "", ".parquet": "polars", ".urdf": ""}
SUFFIXES = (*PAGES, *FILMS, *FIGURES, *FORMATS)
GIF: dict[str, Any] = {
    "width": 480,
    "height": 270,
    "rate": 10.0,
    "duration": 12.0,
}
NAMED = ("width", "height", "rate", "speed", "duration", "camera")
COLUMNS = (
    *("distance_m", "relative_orientation_deg", "min_distance_m"),
    *("captured_at_s", "converged_at_s"),
)
OF_WALKS = ("speed_m_s", "speed_ratio", "yaw_ratio", "tilt_max_deg")
"""Values that a comparison shows."""


@click.command("show")
@click.argument(
    "runs",
    nargs=-1,
    required=True,
    type=EXISTING,
)
@click.option(
    "-o",
    "--output",
    "outputs",
    multiple=True,
    type=click.Path(path_type=Path),
    help="Write a page (.html), film (.mp4, .gif), figure (.png, .svg, "
    ".pdf), ROS 2 bag (.mcap), tables (.csv, .parquet) or robot models "
    "(.urdf); repeatable. Of a bag also a run folder (no suffix).",
)
@click.option(
    "--frame",
    "frames",
    multiple=True,
    metavar="NAME=FRAME",
    help="Of a bag: frame of tf, or topic (/odom), of a player; one option "
    "for each.",
)
@click.option(
    "--repeat/--no-repeat",
    default=True,
    help="Play the game again for what a run folder does not hold: efforts, "
    "IMU, foot forces, plans, strategy, images (.mcap, .csv, .parquet).",
)
@takes_settings(NAMED, FilmSettings)
@browser_option
@json_option
def show(
    runs: tuple[Path, ...],
    outputs: tuple[Path, ...],
    frames: tuple[str, ...],
    repeat: bool,
    settings: FilmSettings,
    opens: bool,
    as_json: bool,
) -> None:
    """Show the runs in the folders RUNS, or write them as files.

    One run opens as a page with a time slider; several are drawn in one
    figure by -o NAME.png, beside a table of their values. Where RUNS is a
    ROS 2 bag (a folder with metadata.yaml, a .mcap or a .db3 file), players
    whose motion was recorded elsewhere are measured, as --frame names them.
    """
    from ..games.run_archive import load_run

    if not any(path.suffix in FILMS for path in outputs):
        refuse_settings(("",), "-o NAME.mp4 or NAME.gif")
    is_bag = runs[0].is_file() or (runs[0] / "metadata.yaml").is_file()
    if frames and not is_bag:
        raise click.UsageError("--frame requires a ROS 2 bag")
    _check_outputs(outputs, is_bag=is_bag)
    bag: dict[str, Any] = {}
    if is_bag:
        loaded: list[Run] = [_measure(runs, frames)]
        bag = loaded[0].results()
    else:
        loaded = [load_run(folder) for folder in runs]
    kinds = sorted({run.game for run in loaded})
    if len(kinds) > 1:
        raise click.UsageError(
            f"all runs must be of the same game, got {' and '.join(kinds)}"
        )
    single = len(loaded) == 1
    shown = single and not is_bag and not outputs
    if shown:
        folder = Path(mkdtemp(prefix="stepaside-"))
        outputs = (folder / f"{loaded[0].name}.html",)
    written: dict[str, Any] = {}
    failed: list[OutputError] = []
    try:
        for path in outputs:
            try:
                written[str(path)] = _write(
                    path, runs, loaded, settings, repeat=repeat
                )
            except OutputError as error:
                failed.append(error)
    except KeyboardInterrupt:
        names_written = ", ".join(written)
        exit_interrupted(
            f"saved: {names_written}" if written else NOTHING_SAVED
        )
    if shown and opens:
        webbrowser.open(outputs[0].absolute().as_uri())
    if as_json:
        results = {
            str(path): run.results()
            for path, run in zip(runs, loaded, strict=True)
        }
        print_json(bag | {"files": written, "runs": results})
    else:
        _print(loaded, written, bag)
    if failed:
        raise failed[0]


def _check_outputs(outputs: tuple[Path, ...], *, is_bag: bool) -> None:
    """Refuse outputs that cannot be written, or that coincide."""
    from ..report.run_folder import check_output

    if len({path.resolve() for path in outputs}) < len(outputs):
        raise ConfigurationError("each -o must name another file")
    for path in outputs:
        if is_bag and path.suffix in (*FILMS, *FORMATS):
            raise click.UsageError(
                f"-o {path} requires a run folder, which -o NAME writes of a "
                "bag"
            )
        if not path.suffix and is_bag:
            check_output(path)
        elif path.suffix in FORMATS:
            check_folder(path, "-o", new=True)
        else:
            check_file(path, "-o", suffixes=SUFFIXES, overwrite=True)


def _measure(bags: tuple[Path, ...], frames: tuple[str, ...]) -> Any:
    """Read the motion of players from a bag."""
    from ..games.experiment import import_experiment

    if len(bags) > 1:
        raise click.UsageError(f"one bag at a time, got {len(bags)}")
    if not frames:
        raise click.UsageError(
            f"{bags[0].name} is a bag: give each player as --frame NAME=FRAME"
        )
    return import_experiment(bags[0], frames)


def _write(
    path: Path,
    folders: tuple[Path, ...],
    runs: "list[Run]",
    film: FilmSettings,
    *,
    repeat: bool,
) -> dict[str, Any]:
    """Write one output; return what JSON says of it.

    Raises:
        OutputError: If it cannot be written.
        UsageError: If there are several runs and it is no figure.
    """
    suffix, more = path.suffix, dict[str, Any]()
    if suffix not in FIGURES and len(runs) > 1:
        raise click.UsageError(
            f"several runs are drawn in a figure ({', '.join(FIGURES)}), got "
            f"-o {path}"
        )
    if not suffix:
        from ..report.run_folder import write_run

        write_run(path, runs[0])
    elif suffix in FIGURES:
        from ..report.run_figure import draw_run, draw_runs

        draw_runs(runs, path) if runs[1:] else draw_run(runs[0], path)
    elif suffix in PAGES:
        from ..report.replay_page import write_page

        write_page(runs[0], path)
    elif suffix in FILMS:
        more["pictures"] = _render(folders[0], path, film)
    else:
        more["absent"] = _export(runs[0], path, repeat=repeat)
    files = (file for file in (path, *path.rglob("*")) if file.is_file())
    return {"bytes": sum(file.stat().st_size for file in files)} | more


def _render(run: Path, file: Path, film: FilmSettings) -> int:
    """Render a film with a progress bar; return the number of images."""
    from ..report.film import write_film

    if file.suffix == ".gif":  # small, unless a size is given
        given = click.get_current_context().meta[GIVEN]
        film = replace(film, **{k: GIF[k] for k in GIF if k not in given})
    # H.264 halves the colour's sides.
    width, height = (side - side % 2 for side in (film.width, film.height))
    film = replace(film, width=width, height=height)
    with ProgressLine("film", unit="frames") as bar:
        return write_film(run, file, film, bar.show)


def _export(run: "Run", folder: Path, *, repeat: bool) -> list[str]:
    """Write a run for other programs; return what is absent."""
    from ..report.export.recording import recording_of

    kind = folder.suffix[1:]
    if FORMATS[folder.suffix]:  # a missing library is told before playing
        import_module(FORMATS[folder.suffix])
    has_signals = kind != "urdf"
    with ProgressLine("repeat", unit="s simulated") as bar:

        def report(progress: "Progress") -> None:
            bar.show(progress.time)

        repeats = repeat and has_signals
        recording = recording_of(run, repeats=repeats, report=report)
    absent = recording.absent
    with (
        folder_draft(folder) as draft,
        ProgressLine("export", unit="samples") as bar,
    ):
        if kind == "mcap":
            from ..report.export.bag_recording import write_bag

            write_bag(draft, recording, bar.show)
        elif has_signals:
            from ..report.export.signal_tables import write_tables

            write_tables(draft, recording, kind)
        else:
            if not recording.models:
                raise ConfigurationError(
                    f"-o {folder} needs a run with a robot, got none"
                )
            recording.write_urdf(draft)
            players = tuple(f"{name}:" for name in recording.run.players)
            absent = tuple(a for a in absent if a.startswith(players))
        draft.rename(folder)
    for sentence in absent:
        echo(f"absent: {sentence}", err=True)
    return list(absent)


def _print(
    runs: "list[Run]", written: dict[str, Any], bag: dict[str, Any]
) -> None:
    """Print values of a bag or of several runs, and what was written."""
    if bag:
        print_run(runs[0])
    elif len(runs) > 1:
        walks = runs[0].game == "walk"
        columns = OF_WALKS if walks else COLUMNS
        print_columns(
            ("run", "outcome", *map(label_of, columns)),
            [
                (
                    visible(run.name),
                    run.outcome.value,
                    *(
                        format_value(name, getattr(summary, name), 4)
                        for name in columns
                    ),
                )
                for run in runs
                for summary in [run.summary.walking if walks else run.summary]
            ],
            left=(0, 1),
        )
    for path, entry in written.items():
        folder = "/" * Path(path).is_dir()
        echo(f"{visible(path)}{folder} ({entry['bytes'] / 1e6:.2f} MB)")
