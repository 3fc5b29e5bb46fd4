"""Store of readings in a folder, each with a key of its dependencies."""

import json
from collections.abc import Callable, Collection, Mapping
from hashlib import sha256
from math import isfinite, nan
from pathlib import Path
from typing import Any

from ..core.atomic_output import atomic_draft, free_file
from .claims import Readings

Key = dict[str, Any]


class ReadingStore:
    """Readings by name in a folder, one file each, written atomically.

    A file with another key is not used, and is replaced. An invalid file is
    set aside as ``NAME.json.aside``.

    Attributes:
        folder: Folder of the files; None stores nothing.
    """

    def __init__(
        self,
        folder: Path | None,
        on_set_aside: Callable[[Path], None] = lambda file: None,
    ) -> None:
        """Open a store.

        Args:
            folder: Folder, which need not exist yet; None stores nothing.
            on_set_aside: Called with each file that is set aside.
        """
        self.folder = folder
        self._on_set_aside = on_set_aside

    def load(
        self, name: str, key: Key, wanted: Collection[str]
    ) -> Readings | None:
        """Return the readings of a name if they have the given key.

        Args:
            name: Name of the file, without suffix.
            key: Everything that the readings depend on, as JSON values.
            wanted: Names of the readings that must be present.
        """
        file = self._file(name)
        if file is None or not file.exists():
            return None
        found = _parse(file)
        if found is not None and found[0] != key:
            return None
        if found is None or set(found[1]) != set(wanted):
            aside = free_file(file.with_name(file.name + ".aside"))
            file.replace(aside)
            self._on_set_aside(aside)
            return None
        return found[1]

    def store(
        self, name: str, key: Key, readings: Mapping[str, float]
    ) -> None:
        """Write readings; NaN and inf become null."""
        file = self._file(name)
        if file is None:
            return
        values = {k: v if isfinite(v) else None for k, v in readings.items()}
        entries = {
            "key": key,
            "readings": values,
            "check": _check(key, values),
        }
        text = json.dumps(entries, indent=1)
        with atomic_draft(file) as draft:
            draft.write_text(text, encoding="utf-8")

    def _file(self, name: str) -> Path | None:
        return None if self.folder is None else self.folder / f"{name}.json"


def _check(key: Key, values: Mapping[str, Any]) -> str:
    """Return the checksum of a key and its readings."""
    text = json.dumps([key, values], sort_keys=True)
    return sha256(text.encode()).hexdigest()[:12]


def _parse(file: Path) -> tuple[Key, Readings] | None:
    """Return key and readings of a file; None if it is invalid."""
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    if not isinstance(found, dict):
        return None
    key, values = found.get("key"), found.get("readings")
    if not isinstance(key, dict) or not isinstance(values, dict):
        return None
    if found.get("check") != _check(key, values):
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
