"""Results of a campaign as JSON lines, for the code that made them."""

import json
from pathlib import Path

from .version import PHYSICS, code_version


def read_results(file: Path | None) -> dict[str, bool]:
    """Results of this version of the code, by key of the trial.

    Args:
        file: Lines of (key, survived, version); a line of another version,
            or one that was cut off when the last run stopped, is left out.
    """
    results: dict[str, bool] = {}
    if file is None or not file.exists():
        return results
    for line in file.read_text(encoding="utf-8").splitlines():
        try:
            key, survived, version = json.loads(line)
        except ValueError:
            continue
        if version == code_version(PHYSICS):
            results[key] = survived
    return results


def note_result(file: Path | None, key: str, survived: bool) -> None:
    """Add a line, at once, so that a campaign can be stopped at any time."""
    if file is None:
        return
    line = json.dumps([key, survived, code_version(PHYSICS)])
    with file.open("a", encoding="utf-8") as out:
        out.write(line + "\n")
