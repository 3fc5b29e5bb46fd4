"""Configuration files: settings read from and written to TOML."""

from collections.abc import Callable, Collection, Mapping
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import tomli_w

from ..arena import Room, room_from_entries, room_to_entries
from ..core.entries import (
    load_entries,
    parse_entries,
    read_entries,
    to_entries,
)
from ..core.errors import AnyPath, as_path

ROBOTS = "robots"  # folder of descriptions and networks in a run folder
S = TypeVar("S")  # a frozen dataclass of settings
READERS = {Room: room_from_entries}
WRITERS = {Room: room_to_entries}


def parse_settings(
    kind: type[S],
    entries: Mapping[str, Any],
    source: str,
    *,
    aside: Collection[str] = (),
    base: S | None = None,
) -> S:
    """Turn nested entries into settings; see :func:`.read_entries`."""
    return read_entries(
        kind, entries, source, base=base, readers=READERS, aside=aside
    )


def read_settings(
    kind: type[S], text: str, source: str, *, aside: Collection[str] = ()
) -> S:
    """Parse settings from TOML text; see :func:`.read_entries`."""
    return parse_settings(
        kind, parse_entries(text, source), source, aside=aside
    )


def load_settings(path: AnyPath) -> dict[str, Any]:
    """Read the entries of a file of settings, with the files beside it.

    Raises:
        ConfigurationError: If the file is not TOML.
    """
    file = as_path(path, "path")
    entries = load_entries(file)
    find_files(entries, file.parent)
    return entries


def find_files(entries: Any, folder: Path) -> None:
    """Find robots and networks that a run folder holds."""

    def found(value: str) -> str:
        inside = value.startswith(f"{ROBOTS}/") and ".." not in value
        there = folder.resolve() / value
        return str(there) if inside and there.exists() else value

    replace_files(entries, found)


def replace_files(entries: Any, change: Callable[[str], str]) -> None:
    """Replace the names of robots and networks in nested entries."""
    if isinstance(entries, list):
        for each in entries:
            replace_files(each, change)
    elif isinstance(entries, dict):
        for key, value in entries.items():
            if key in ("robot", "network") and isinstance(value, str):
                entries[key] = change(value)
            else:
                replace_files(value, change)


def dump_configuration(settings: Any) -> str:
    """Return the TOML text from which the same settings are read."""
    return tomli_w.dumps(settings_entries(settings))


def settings_entries(settings: Any) -> dict[str, Any]:
    """Return settings as the nested entries of a configuration file.

    What they leave open is resolved.
    """
    if hasattr(settings, "resolved"):
        settings = settings.resolved()
    entries: dict[str, Any] = to_entries(settings, WRITERS)
    return entries


def json_settings(settings: Any) -> dict[str, Any]:
    """Return settings for JSON; infinite values become text."""
    entries: dict[str, Any] = _spelled(settings_entries(settings))
    return entries


def _spelled(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _spelled(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_spelled(entry) for entry in value]
    infinite = isinstance(value, float) and not isfinite(value)
    return str(value) if infinite else value
