"""``stepaside export``: a run in the formats of other programs."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..core.atomic_output import check_folder
from .options.common_options import json_option
from .progress import show_progress
from .tables import print_table
from .terminal import echo, print_json

if TYPE_CHECKING:
    from ..games.match import Progress
    from ..report.export.recording import Recording

FORMATS = ("mcap", "urdf", "csv", "parquet")


@click.command("export")
@click.argument(
    "run", type=click.Path(exists=True, file_okay=False, path_type=Path)
)
@click.option(
    "--to",
    "format_name",
    required=True,
    type=click.Choice(FORMATS),
    help="Format: a ROS 2 bag, robot models, or tables.",
)
@click.option(
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder to create; RUN-FORMAT by default.",
)
@click.option(
    "--repeat/--no-repeat",
    default=None,
    help="Play the game again for what a run folder does not hold: efforts, "
    "IMU, foot forces, plans, strategy, images. By default where the format "
    "holds them.",
)
@json_option
def export(
    run: Path,
    format_name: str,
    output: Path | None,
    repeat: bool | None,
    as_json: bool,
) -> None:
    """Write the run in the folder RUN in the format of other programs."""
    from ..report.export.export_formats import (
        FORMATS,
        check_format,
        export_recording,
    )

    run = run.resolve()
    folder = output or run.with_name(f"{run.name}-{format_name}")
    check_folder(folder, new=True)
    check_format(format_name)
    if repeat is None:
        repeat = FORMATS[format_name].repeats
    recording = _load(run, repeats=repeat)
    with show_progress("export", unit="samples") as bar:

        def report(done: int, number: int) -> None:
            bar.total, bar.n = number, done
            bar.refresh()

        files = export_recording(folder, format_name, recording, report)
    absent = recording.absent
    if not FORMATS[format_name].repeats:  # it has no signals at all
        players = tuple(f"{name}:" for name in recording.run.players)
        absent = tuple(each for each in absent if each.startswith(players))
    sizes = {
        str(file.relative_to(folder)): file.stat().st_size for file in files
    }
    if as_json:
        print_json(
            {
                "folder": str(folder),
                "format": format_name,
                "files": sizes,
                "absent": list(absent),
            }
        )
        return
    for sentence in absent:
        echo(f"absent: {sentence}", err=True)
    print_table(
        [(name, f"{size / 1e6:.2f} MB") for name, size in sizes.items()]
    )
    echo(f"\nfolder: {folder}")


def _load(run: Path, *, repeats: bool) -> "Recording":
    """Read a run, and play its game again with a progress bar."""
    from ..report.export.recording import load_recording

    look = "{desc} {bar} {n:.0f} s simulated"
    with show_progress("repeat", None, "s simulated", bar_format=look) as bar:

        def report(progress: "Progress") -> None:
            bar.n = progress.time
            bar.refresh()

        return load_recording(run, repeats=repeats, report=report)
