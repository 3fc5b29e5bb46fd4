"""Formats in which recordings are written."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from ...core.atomic_output import folder_draft
from ...core.errors import ConfigurationError
from .recording import Recording

Report = Callable[[int, int], None]


class ExportFormat(NamedTuple):
    """Format of recordings.

    Attributes:
        contents: What the folder holds, for help.
        needs: Modules that write it.
        repeats: Whether it holds more than the run folder, so that the game
            is played again.
        write: Function that writes the files into a folder.
    """

    contents: str
    needs: tuple[str, ...]
    repeats: bool
    write: Callable[[Path, Recording, Report | None], None]


def _write_mcap(folder: Path, run: Recording, report: Report | None) -> None:
    from .bag_recording import write_bag

    write_bag(folder, run, report)


def _write_csv(folder: Path, run: Recording, report: Report | None) -> None:
    from .signal_tables import write_csv

    write_csv(folder, run)


def _write_parquet(
    folder: Path, run: Recording, report: Report | None
) -> None:
    from .signal_tables import write_parquet

    write_parquet(folder, run)


def _write_urdf(folder: Path, run: Recording, report: Report | None) -> None:
    for name, model in run.models.items():
        (folder / f"{name}.urdf").write_text(model.urdf, encoding="utf-8")


FORMATS = {
    "mcap": ExportFormat(
        "a ROS 2 bag for Foxglove, Rerun, PlotJuggler and rosbag2",
        ("rosbags",),
        True,
        _write_mcap,
    ),
    "urdf": ExportFormat(
        "the models of the robots, for ROS and simulators",
        (),
        False,
        _write_urdf,
    ),
    "csv": ExportFormat(
        "tables for spreadsheets and PlotJuggler", (), True, _write_csv
    ),
    "parquet": ExportFormat(
        "the same tables as Parquet", ("polars",), True, _write_parquet
    ),
}


def check_format(name: str) -> None:
    """Import the modules that write a format.

    Raises:
        ModuleNotFoundError: If one is not installed.
    """
    for module in FORMATS[name].needs:
        import_module(module)


def export_recording(
    folder: Path,
    name: str,
    recording: Recording,
    report: Report | None = None,
) -> list[Path]:
    """Write a recording; the folder appears when it is complete.

    Args:
        folder: New or empty folder.
        name: Name of the format, one of ``FORMATS``.
        recording: The recording.
        report: Called with the samples done and their number.

    Returns:
        The files.

    Raises:
        OutputError: If it cannot be written.
        ConfigurationError: If the format is of robots and there are none.
    """
    if name == "urdf" and not recording.models:
        raise ConfigurationError(
            f"format {name} needs a run with a robot, got none"
        )
    with folder_draft(folder) as draft:
        FORMATS[name].write(draft, recording, report)
        names = sorted(
            file.relative_to(draft)
            for file in draft.rglob("*")
            if file.is_file()
        )
        draft.rename(folder)
    return [folder / file for file in names]
