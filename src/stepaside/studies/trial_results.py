"""Which trials of a campaign were survived, for the code that played them."""

from pathlib import Path
from typing import Any

from .records import RecordFile
from .version import code_version, library_versions

# Modules that play a trial and judge it.
ROOMS = ("studies/robustness", "studies/encounters")


def read_results(file: Path | None) -> dict[str, bool]:
    """Results of this version of the code and libraries, by key of the trial.

    Args:
        file: Of :class:`RecordFile`; those of another version, and lines
            that are not whole, are left out. None holds nothing.
    """
    if file is None:
        return {}
    now = stamp()
    return {
        key: bool(record["survived"])
        for key, record in RecordFile(file).read(["survived"]).items()
        if all(record.get(name) == now[name] for name in now)
    }


def note_result(file: Path | None, key: str, survived: bool) -> None:
    """Add a result, at once, so that a campaign can be stopped any time."""
    if file is not None:
        RecordFile(file).append(key, record_of(survived))


def record_of(survived: bool) -> dict[str, Any]:
    """A result as it is recorded, with what it is of."""
    return {"survived": survived} | stamp()


def stamp() -> dict[str, Any]:
    """Versions of the code and the libraries that a result is of."""
    return {"version": code_version(ROOMS), "libraries": library_versions()}
