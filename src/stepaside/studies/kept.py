"""Readings that a folder keeps, each with the key of what it depends on."""

import json
from collections.abc import Collection, Mapping
from math import isfinite, nan
from pathlib import Path
from typing import Any

from ..outputs import writing
from .readings import Readings

Key = dict[str, Any]


class Kept:
    """Readings by name in a folder; one file each, written at one stroke.

    A file that was made from another key is not used, and is replaced. One
    that is torn or not ours is set aside, as ``NAME.json.aside``.
    """

    def __init__(self, folder: Path | None) -> None:
        """Keep in a folder, which need not exist yet; None keeps nothing."""
        self.folder = folder

    def load(
        self, name: str, key: Key, wanted: Collection[str]
    ) -> Readings | None:
        """Readings of a name, if they were made from this very key.

        Args:
            name: Name of the file, less its suffix.
            key: All that the readings depend on, as JSON values.
            wanted: Names of the readings that must be there.
        """
        file = self._file(name)
        if file is None or not file.exists():
            return None
        found = _parse(file)
        if found is not None and found[0] != key:
            return None
        if found is None or set(found[1]) != set(wanted):
            file.replace(file.with_name(file.name + ".aside"))
            return None
        return found[1]

    def store(
        self, name: str, key: Key, readings: Mapping[str, float]
    ) -> None:
        """Keep readings; what is not finite becomes null."""
        file = self._file(name)
        if file is None:
            return
        values = {k: v if isfinite(v) else None for k, v in readings.items()}
        text = json.dumps({"key": key, "readings": values}, indent=1)
        with writing(file) as draft:
            draft.write_text(text, encoding="utf-8")

    def _file(self, name: str) -> Path | None:
        return None if self.folder is None else self.folder / f"{name}.json"


def _parse(file: Path) -> tuple[Key, Readings] | None:
    """Key and readings of a file; None unless it is whole and ours."""
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    if not isinstance(found, dict):
        return None
    key, values = found.get("key"), found.get("readings")
    if not isinstance(key, dict) or not isinstance(values, dict):
        return None
    readings: Readings = {}
    for name, value in values.items():
        if value is None:
            readings[name] = nan
        elif isinstance(value, int | float) and not isinstance(value, bool):
            readings[name] = float(value)
        else:
            return None
    return key, readings
