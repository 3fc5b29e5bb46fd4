"""Configuration files: settings read from and written to TOML."""

from collections.abc import Callable
from math import isfinite
from typing import Any

import tomli_w

from ..core.entries import load_entries, to_entries
from ..core.errors import AnyPath, as_path

ROBOTS = "robots"  # folder of descriptions and networks in a run folder


def load_settings(path: AnyPath) -> dict[str, Any]:
    """Read the entries of a file, with robots and networks beside it."""
    file = as_path(path, "path")
    entries = load_entries(file)

    def found(value: str) -> str:
        inside = value.startswith(f"{ROBOTS}/") and ".." not in value
        there = file.parent.resolve() / value
        return str(there) if inside and there.exists() else value

    replace_files(entries, found)
    return entries


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
    entries: dict[str, Any] = to_entries(settings)
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
