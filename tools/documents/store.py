"""Access to results by name, and to their values by address."""

import json
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "docs" / "results"
SHOWN = 8  # keys that a message names


class DocumentError(ValueError):
    """Reference to a missing result or value."""


class Store:
    """Results in a folder; each file is read once.

    Attributes:
        folder: Folder of the results.
    """

    def __init__(self, folder: Path = RESULTS) -> None:
        self.folder = folder
        self._read: dict[str, dict[str, Any]] = {}

    def names(self) -> list[str]:
        """Return the names of all results."""
        return sorted(file.stem for file in self.folder.glob("*.json"))

    def result(self, name: str) -> dict[str, Any]:
        """Return one result.

        Raises:
            DocumentError: If it does not exist.
        """
        if name not in self._read:
            try:
                text = (self.folder / f"{name}.json").read_text("utf-8")
                found = dict(json.loads(text))
            except (FileNotFoundError, ValueError) as error:
                raise DocumentError(f"no result {name}.json") from error
            self._read[name] = found
        return self._read[name]

    def value(self, address: str) -> Any:
        """Return the value at ``name:key.key.0.key``; numbers index lists.

        A key may contain dots, as in ``by.push.0.8.falls``: the longest
        existing one counts.

        Raises:
            DocumentError: If there is no such value; names the keys.
        """
        name, _, path = address.partition(":")
        value: Any = self.result(name)
        keys = path.split(".")
        while keys:
            for number in range(len(keys), 0, -1):
                key = ".".join(keys[:number])
                found = _child(value, key)
                if found is not _NOTHING:
                    value, keys = found, keys[number:]
                    break
            else:
                raise DocumentError(
                    f"{address}: no {keys[0]!r} among {_keys(value)}"
                )
        return value


_NOTHING = object()


def _child(value: Any, key: str) -> Any:
    if isinstance(value, dict):
        return value.get(key, _NOTHING)
    if isinstance(value, list) and key.isdigit() and int(key) < len(value):
        return value[int(key)]
    return _NOTHING


def _keys(value: Any) -> str:
    if isinstance(value, dict):
        keys = [str(key) for key in value]
        more = "" if len(keys) <= SHOWN else ", ..."
        return ", ".join(keys[:SHOWN]) + more
    if isinstance(value, list):
        return f"{len(value)} entries"
    return repr(value)
