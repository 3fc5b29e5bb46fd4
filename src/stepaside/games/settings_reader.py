"""Files of settings, read and written."""

from collections.abc import Callable
from typing import Any

import tomli_w

from ..core.entries import load_entries, to_entries
from ..core.errors import AnyPath, as_path
from .game_settings import GameSettings, read_game

ROBOTS = "robots"  # folder of descriptions and networks in a run folder


def load_game(path: AnyPath, **changes: Any) -> GameSettings:
    """Read a TOML file of a game, with changes of its entries.

    Raises:
        StepAsideError: If the file is not TOML, an entry is unknown or
            invalid, or a robot does not exist.
    """
    return read_game(load_settings(path), str(path)).changed(**changes)


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
