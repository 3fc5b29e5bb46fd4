"""Readings that a folder keeps, each with the key of what it depends on."""

import json
from collections.abc import Collection, Mapping
from math import isfinite, nan
from pathlib import Path
from typing import Any

from .readings import Readings

Key = dict[str, Any]


class Kept:
    """Readings by name in a folder; one file each, written at one stroke.

    A file that is torn, is not ours or was made from another key is set
    aside, as ``NAME.json.aside``, and its readings are not used.
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
        readings = _parse(file, key, wanted)
        if readings is None:
            file.replace(file.with_name(file.name + ".aside"))
        return readings

    def store(
        self, name: str, key: Key, readings: Mapping[str, float]
    ) -> None:
        """Keep readings; what is not finite becomes null."""
        file = self._file(name)
        if file is None:
            return
        file.parent.mkdir(parents=True, exist_ok=True)
        values = {k: v if isfinite(v) else None for k, v in readings.items()}
        draft = file.with_suffix(".part")
        text = json.dumps({"key": key, "readings": values}, indent=1)
        draft.write_text(text, encoding="utf-8")
        draft.replace(file)

    def _file(self, name: str) -> Path | None:
        return None if self.folder is None else self.folder / f"{name}.json"


def _parse(file: Path, key: Key, wanted: Collection[str]) -> Readings | None:
    """Readings of a file; None unless it is whole, ours and of the key."""
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    if not isinstance(found, dict) or found.get("key") != key:
        return None
    values = found.get("readings")
    if not isinstance(values, dict) or set(values) != set(wanted):
        return None
    readings: Readings = {}
    for name, value in values.items():
        if value is None:
            readings[name] = nan
        elif isinstance(value, int | float) and not isinstance(value, bool):
            readings[name] = float(value)
        else:
            return None
    return readings
