"""Readings that a folder keeps, each with the key of what it depends on."""

import json
from collections.abc import Callable, Collection, Mapping
from hashlib import sha256
from math import isfinite, nan
from pathlib import Path
from typing import Any

from ..core.atomic_output import free_file, writing
from .claims import Readings

Key = dict[str, Any]


class ReadingStore:
    """Readings by name in a folder; one file each, written at one stroke.

    A file that was made from another key is not used, and is replaced. One
    that is torn or not ours is set aside, as ``NAME.json.aside``.

    Attributes:
        folder: Where they lie; None if nothing is kept.
    """

    def __init__(
        self,
        folder: Path | None,
        tell: Callable[[Path], None] = lambda file: None,
    ) -> None:
        """Keep readings.

        Args:
            folder: It need not exist yet; None keeps nothing.
            tell: Told which files are set aside.
        """
        self.folder, self._tell = folder, tell

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
            aside = free_file(file.with_name(file.name + ".aside"))
            file.replace(aside)
            self._tell(aside)
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
        whole = {"key": key, "readings": values, "check": _check(key, values)}
        text = json.dumps(whole, indent=1)
        with writing(file) as draft:
            draft.write_text(text, encoding="utf-8")

    def _file(self, name: str) -> Path | None:
        return None if self.folder is None else self.folder / f"{name}.json"


def _check(key: Key, values: Mapping[str, Any]) -> str:
    """Checksum of a key and its readings."""
    text = json.dumps([key, values], sort_keys=True)
    return sha256(text.encode()).hexdigest()[:12]


def _parse(file: Path) -> tuple[Key, Readings] | None:
    """Key and readings of a file; None unless it is whole and ours."""
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
