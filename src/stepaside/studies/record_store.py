"""Results of a long study on disk: one whole, checked record a line."""

import json
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..core.atomic_output import reason_of, writing
from ..core.errors import OutputError

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

DIGITS = 12


class RecordStore:
    """Records by key; what was cut off or altered is done again.

    A line holds a key, a record and a checksum of both. Lines that are torn
    or foreign are kept beside the file, with ``.aside`` behind its name, and
    count as not done.

    Attributes:
        path: JSON lines.
        aside: How many lines were set aside.
    """

    def __init__(self, path: Path) -> None:
        """Open a file of records, or a place for one; nothing is written."""
        self.path = path
        self.aside = 0

    def read(self, fields: Iterable[str] = ()) -> dict[str, dict[str, Any]]:
        """Records by key; of several with one key, the last.

        Args:
            fields: That every record must have; one without is foreign.
        """
        if not self.path.exists():
            return {}
        with alone_in(self.path.parent):
            return self._read(set(fields))

    def _read(self, fields: set[str]) -> dict[str, dict[str, Any]]:
        found: dict[str, dict[str, Any]] = {}
        bad: list[str] = []
        text = self.path.read_text(encoding="utf-8", errors="replace")
        for line in filter(None, text.split("\n")):
            entry = _parse(line)
            if entry is None or not fields <= entry[1].keys():
                bad.append(line)
            else:
                found[entry[0]] = entry[1]
        if bad:
            self._set_aside(bad, found)
        return found

    def append(self, key: str, record: dict[str, Any]) -> None:
        """Add one record, on a line of its own whatever was before.

        Raises:
            OutputError: If the system does not let it be written.
        """
        line = _line(key, record).encode()
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            made = not self.path.exists()
            # Without a buffer, which would be written again as it is closed.
            with (
                alone_in(self.path.parent),
                self.path.open("ab+", buffering=0) as out,
            ):
                end = out.seek(0, os.SEEK_END)
                if end:
                    out.seek(-1, os.SEEK_END)
                    line = line if out.read(1) == b"\n" else b"\n" + line
                try:
                    while line:
                        line = line[out.write(line) :]
                except OSError:  # nothing of it stays where room ran out
                    os.truncate(self.path, end)
                    if made and not end:
                        self.path.unlink()
                    raise
        except OSError as error:
            raise OutputError(
                f"{self.path} could not be written: {reason_of(error)}"
            ) from error

    def write(self, records: dict[str, dict[str, Any]]) -> None:
        """Replace the file by these records, whole or not at all."""
        lines = [_line(key, record) for key, record in records.items()]
        with writing(self.path) as draft:
            draft.write_text("".join(lines), encoding="utf-8")

    def _set_aside(
        self, lines: list[str], good: dict[str, dict[str, Any]]
    ) -> None:
        """Move bad lines out of the way, so that none grows onto them."""
        self.aside += len(lines)
        place = self.path.with_name(self.path.name + ".aside")
        with place.open("a", encoding="utf-8") as out:
            out.writelines(line + "\n" for line in lines)
        self.write(good)


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Wait until no other process reads or writes records of a folder.

    Where the system knows no such locks, nobody waits.

    Args:
        folder: It exists.
    """
    if fcntl is None:
        yield
        return
    place = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # some file systems have none
            fcntl.flock(place, fcntl.LOCK_EX)
        yield
    finally:
        os.close(place)


def _line(key: str, record: dict[str, Any]) -> str:
    check = _checksum(key, record)
    line = {"key": key, "check": check, "record": record}
    return json.dumps(line, allow_nan=False) + "\n"


def _checksum(key: str, record: Any) -> str:
    text = json.dumps([key, record], sort_keys=True)
    return sha256(text.encode()).hexdigest()[:DIGITS]


def _parse(line: str) -> tuple[str, dict[str, Any]] | None:
    """Key and record of a line; None unless it is whole."""
    try:
        entry = json.loads(line)
        key, record = entry["key"], entry["record"]
        whole = entry["check"] == _checksum(key, record)
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    if whole and isinstance(key, str) and isinstance(record, dict):
        return key, record
    return None
