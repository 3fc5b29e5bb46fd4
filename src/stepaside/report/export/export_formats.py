"""Formats in which recordings are written."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from ...core.atomic_output import folder_draft
from ...core.errors import ConfigurationError
from .recording import Recording

# Library that writes each format, if that needs one.
FORMATS = {"mcap": "rosbags", "urdf": "", "csv": "", "parquet": "polars"}


def check_format(name: str) -> None:
    """Import the library that writes a format.

    Raises:
        ModuleNotFoundError: If it is not installed.
    """
    if FORMATS[name]:
        import_module(FORMATS[name])


def export_recording(
    folder: Path,
    name: str,
    recording: Recording,
    report: Callable[[int, int], None],
) -> None:
    """Write a recording; the folder appears when it is complete.

    Args:
        folder: New or empty folder.
        name: Name of the format, one of ``FORMATS``.
        recording: The recording.
        report: Called with the samples done and their number.

    Raises:
        OutputError: If it cannot be written.
        ConfigurationError: If the format is of robots and there are none.
    """
    if name == "urdf" and not recording.models:
        raise ConfigurationError(
            f"format {name} needs a run with a robot, got none"
        )
    with folder_draft(folder) as draft:
        if name == "mcap":
            from .bag_recording import write_bag

            write_bag(draft, recording, report)
        elif name == "urdf":
            recording.write_urdf(draft)
        else:
            from .signal_tables import write_csv, write_parquet

            write = write_csv if name == "csv" else write_parquet
            write(draft, recording)
        draft.rename(folder)
