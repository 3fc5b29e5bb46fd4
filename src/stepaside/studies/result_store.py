"""Store of results: one folder, to which any number of processes append."""

import json
import os
import platform
import shutil
import tempfile
import weakref
from collections.abc import Collection, Iterable, Iterator, Mapping
from datetime import UTC, datetime
from hashlib import sha256
from io import BufferedReader
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

from ..core.atomic_output import atomic_draft, reason_of
from ..core.errors import OutputError
from .records import Record

SUFFIX = ".jsonl"
MERGED = f"0-merged{SUFFIX}"  # sorts before the files of writers
STAMP = ("version", "libraries")  # entries that name code and libraries
DIGITS = 12  # of a checksum
OPEN_FILES = 64  # read at a time; a study of many shards has many files
OFFSET_BITS = 40  # of a position; a file has at most 1 TiB


class StoredRecord(NamedTuple):
    """A record in a store.

    Attributes:
        key: Key of its case.
        record: Measured values, with version and libraries.
        position: Place in the store, for :meth:`ResultStore.record_at`.
    """

    key: str
    record: Record
    position: int


class ResultStore:
    """Folder of records, in append-only files of JSON lines.

    Every writer has a file of its own, so that processes on one or on many
    machines can share a folder, also on a network file system without locks.
    A line holds a key, a record and a checksum of both. A line that a killed
    writer left incomplete, or that was altered, is skipped. Of several
    records with the same key the last one counts, in the order of the names
    of the files, which begin with the time of their creation.

    Attributes:
        folder: Folder of the files.
        invalid_lines: Number of invalid lines of each file, as of the last
            reading.
        files: Files by their number in positions.
    """

    def __init__(self, folder: Path) -> None:
        """Open a store; nothing is read or written.

        Args:
            folder: Folder of the records, which need not exist yet.
        """
        self.folder = folder
        self.invalid_lines: dict[Path, int] = {}
        self.files: list[Path] = []
        self._open: dict[int, BufferedReader] = {}

    @classmethod
    def temporary(cls) -> "ResultStore":
        """Return a store that is removed together with this object."""
        folder = Path(tempfile.mkdtemp(prefix="stepaside-"))
        store = cls(folder)
        weakref.finalize(store, shutil.rmtree, folder, ignore_errors=True)
        return store

    def entries(self) -> Iterator[StoredRecord]:
        """Yield all valid records, file by file."""
        self.invalid_lines = {}
        for file in sorted(self.folder.glob(f"*{SUFFIX}")):
            number, offset = self.number_of(file), 0
            with file.open("rb") as lines:
                for line in lines:
                    found = parse_line(line)
                    if found is not None:
                        position = number << OFFSET_BITS | offset
                        yield StoredRecord(*found, position)
                    elif line.strip():
                        bad = self.invalid_lines.get(file, 0)
                        self.invalid_lines[file] = bad + 1
                    offset += len(line)

    def read(self) -> dict[str, Record]:
        """Return the records by key."""
        return {entry.key: entry.record for entry in self.entries()}

    def record_at(self, position: int) -> Record:
        """Return the record at a position."""
        number, offset = position >> OFFSET_BITS, position % 2**OFFSET_BITS
        if number not in self._open:
            while len(self._open) >= OPEN_FILES:
                self._open.pop(next(iter(self._open))).close()
            self._open[number] = self.files[number].open("rb")
        lines = self._open[number]
        lines.seek(offset)
        record: Record = json.loads(lines.readline())["record"]
        return record

    def writer(self) -> "RecordWriter":
        """Return a writer with a file of its own."""
        return RecordWriter(self)

    def close(self) -> None:
        """Close the files that were opened for reading."""
        while self._open:
            self._open.popitem()[1].close()

    def number_of(self, file: Path) -> int:
        """Return the number of a file in positions."""
        if file not in self.files:
            self.files.append(file)
        return self.files.index(file)


class RecordWriter:
    """Appends records to a file of its own, which the first one creates."""

    def __init__(self, store: ResultStore) -> None:
        """Begin without a file."""
        self._store = store
        self._descriptor: int | None = None
        self._number, self._end = 0, 0

    def __enter__(self) -> "RecordWriter":
        """Return the writer."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the file."""
        if self._descriptor is not None:
            os.close(self._descriptor)

    def append(self, entries: Iterable[tuple[str, Record]]) -> list[int]:
        """Append records at once; return their positions.

        Args:
            entries: Key and record of each.

        Raises:
            OutputError: If they cannot be written; then none of them is.
        """
        lines = [_line(*entry).encode() for entry in entries]
        try:
            if self._descriptor is None:
                self._descriptor = self._create()
            left = b"".join(lines)
            try:
                while left:
                    left = left[os.write(self._descriptor, left) :]
            except OSError:  # disk full: remove what was written of them
                self._take_back(self._descriptor)
                raise
        except OSError as error:
            raise OutputError(
                f"{self._store.folder} could not be written: "
                f"{reason_of(error)}"
            ) from error
        positions = []
        for line in lines:
            positions.append(self._number << OFFSET_BITS | self._end)
            self._end += len(line)
        return positions

    def _take_back(self, descriptor: int) -> None:
        """Remove an incomplete end; and the file, if nothing else is in it."""
        os.ftruncate(descriptor, self._end)
        if not self._end:
            os.close(descriptor)
            self._descriptor = None
            self._store.files[self._number].unlink()

    def _create(self) -> int:
        self._store.folder.mkdir(parents=True, exist_ok=True)
        time = datetime.now(UTC).strftime("%Y%m%dT%H%M%S%f")
        host = sha256(platform.node().encode()).hexdigest()[:6]
        name = f"{time}-{host}-{os.getpid()}{SUFFIX}"
        file = self._store.folder / name
        self._number = self._store.number_of(file)
        return os.open(file, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)


class RecordIndex:
    """Positions of the records of a store, by key and by their stamp.

    A stamp is the version of the code and of the libraries that measured a
    record.
    """

    def __init__(
        self, store: ResultStore, fields: Collection[str] = ()
    ) -> None:
        """Read a store.

        Args:
            store: Store.
            fields: Values that a record must have; others do not count.
        """
        needed = set(fields)
        self._positions: dict[str, dict[str, int]] = {}
        for key, record, position in store.entries():
            if needed <= record.keys():
                stamp = stamp_text(record)
                self._positions.setdefault(stamp, {})[key] = position

    def __bool__(self) -> bool:
        """Whether there is any record."""
        return bool(self._positions)

    def find(self, key: str, stamp: str) -> int | None:
        """Return the position of the record of a case with a stamp."""
        return self._positions.get(stamp, {}).get(key)


def stamp_text(record: Mapping[str, Any]) -> str:
    """Return version and libraries of a record as text."""
    return json.dumps([record.get(name) for name in STAMP], sort_keys=True)


def merge_stores(parts: Iterable[ResultStore], whole: ResultStore) -> int:
    """Join the records of stores in one file of another store.

    Args:
        parts: Stores to read; ``whole`` may be one of them. Their files
            stay.
        whole: Store whose file ``MERGED`` is written or replaced.

    Returns:
        Number of different records that were joined.

    Raises:
        OutputError: If the file cannot be written.
    """
    known: set[str] = set()
    with (
        atomic_draft(whole.folder / MERGED) as draft,
        draft.open("w", encoding="utf-8") as out,
    ):
        for part in parts:
            for key, record, _ in part.entries():
                line = _line(key, record)
                digest = sha256(line.encode()).hexdigest()
                if digest not in known:
                    out.write(line)
                    known.add(digest)
    return len(known)


def _line(key: str, record: Record) -> str:
    check = _checksum(key, record)
    line = {"key": key, "check": check, "record": record}
    return json.dumps(line, allow_nan=False) + "\n"


def _checksum(key: str, record: Any) -> str:
    text = json.dumps([key, record], sort_keys=True)
    return sha256(text.encode()).hexdigest()[:DIGITS]


def parse_line(line: bytes) -> tuple[str, Record] | None:
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
