"""Record store of a campaign: one checksummed JSON record per line."""

import json
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..core.atomic_output import atomic_draft, reason_of
from ..core.errors import OutputError

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

DIGITS = 12


class RecordStore:
    """Records by key, in a file of JSON lines.

    A line holds a key, a record and a checksum of both. Incomplete, altered
    or unknown lines are moved to a file with the suffix ``.aside``, and
    their records are computed again.

    Attributes:
        path: File of JSON lines.
        aside: Number of lines that were set aside.
    """

    def __init__(self, path: Path) -> None:
        """Make a store for a path; nothing is read or written."""
        self.path = path
        self.aside = 0

    def read(self, fields: Iterable[str] = ()) -> dict[str, dict[str, Any]]:
        """Read the records by key; the last of several with the same key.

        Args:
            fields: Required entries of a record; others are set aside.
        """
        if not self.path.exists():
            return {}
        with exclusive_access(self.path.parent):
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
        """Append one record; an incomplete last line does not corrupt it.

        Raises:
            OutputError: If it cannot be written.
        """
        line = _line(key, record).encode()
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            is_new = not self.path.exists()
            # Unbuffered: a buffer would be written again on close.
            with (
                exclusive_access(self.path.parent),
                self.path.open("ab+", buffering=0) as out,
            ):
                end = out.seek(0, os.SEEK_END)
                if end:
                    out.seek(-1, os.SEEK_END)
                    line = line if out.read(1) == b"\n" else b"\n" + line
                try:
                    while line:
                        line = line[out.write(line) :]
                except OSError:  # disk full: remove the partial line
                    os.truncate(self.path, end)
                    if is_new and not end:
                        self.path.unlink()
                    raise
        except OSError as error:
            raise OutputError(
                f"{self.path} could not be written: {reason_of(error)}"
            ) from error

    def write(self, records: dict[str, dict[str, Any]]) -> None:
        """Replace the content of the file atomically."""
        lines = [_line(key, record) for key, record in records.items()]
        with atomic_draft(self.path) as draft:
            draft.write_text("".join(lines), encoding="utf-8")

    def _set_aside(
        self, lines: list[str], good: dict[str, dict[str, Any]]
    ) -> None:
        """Move bad lines to the file ``.aside``."""
        self.aside += len(lines)
        aside = self.path.with_name(self.path.name + ".aside")
        with aside.open("a", encoding="utf-8") as out:
            out.writelines(line + "\n" for line in lines)
        self.write(good)


@contextmanager
def exclusive_access(folder: Path) -> Iterator[None]:
    """Lock the records of a folder against other processes.

    Without effect on systems and file systems without such locks.

    Args:
        folder: Existing folder.
    """
    if fcntl is None:
        yield
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # not supported by all file systems
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def _line(key: str, record: dict[str, Any]) -> str:
    check = _checksum(key, record)
    line = {"key": key, "check": check, "record": record}
    return json.dumps(line, allow_nan=False) + "\n"


def _checksum(key: str, record: Any) -> str:
    text = json.dumps([key, record], sort_keys=True)
    return sha256(text.encode()).hexdigest()[:DIGITS]


def _parse(line: str) -> tuple[str, dict[str, Any]] | None:
    """Return key and record of a line; None if it is not valid."""
    try:
        entry = json.loads(line)
        key, record = entry["key"], entry["record"]
        valid = entry["check"] == _checksum(key, record)
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    if valid and isinstance(key, str) and isinstance(record, dict):
        return key, record
    return None
