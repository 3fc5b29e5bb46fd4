"""Tables of records: one column per value, for pandas, polars and DuckDB."""

import json
import sqlite3
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.atomic_output import atomic_draft
from .records import Record

if TYPE_CHECKING:
    import polars

TABLES = (".parquet", ".sqlite")
"""Suffixes of the files of tables."""
CHUNK = 50_000  # records that are in memory at a time


def flat_record(record: Record) -> dict[str, Any]:
    """Return a record as one row of a table.

    Nested entries become columns with dotted names, as in
    ``libraries.numpy``; lists become JSON text.
    """
    row: dict[str, Any] = {}
    for name, value in record.items():
        if isinstance(value, dict):
            for inner, one in flat_record(value).items():
                row[f"{name}.{inner}"] = one
        elif isinstance(value, list):
            row[name] = json.dumps(value)
        else:
            row[name] = value
    return row


def to_frame(records: Iterable[Record]) -> "polars.DataFrame":
    """Return records as a polars frame, one row each.

    Integers and numbers in one column become numbers; a value that a record
    lacks is null. ``.to_pandas()`` gives a frame of pandas.

    Raises:
        ModuleNotFoundError: Without the extra ``tables``.
    """
    import polars

    frames = [
        polars.DataFrame(
            [flat_record(record) for record in chunk],
            infer_schema_length=None,
        )
        for chunk in _chunks(records)
    ]
    if not frames:
        return polars.DataFrame()
    return polars.concat(frames, how="diagonal_relaxed")


def write_table(records: Iterable[Record], file: Path) -> None:
    """Write records as a table, atomically.

    Args:
        records: Records.
        file: File with one of the suffixes ``TABLES``. Parquet needs the
            extra ``tables``; in SQLite the table is named ``results``.

    Raises:
        OutputError: If it cannot be written.
    """
    with atomic_draft(file) as draft:
        if file.suffix.lower() == ".parquet":
            to_frame(records).write_parquet(draft)
        else:
            _write_sqlite(records, draft)


def _chunks(records: Iterable[Record]) -> Iterator[list[Record]]:
    left = iter(records)
    while chunk := list(islice(left, CHUNK)):
        yield chunk


def _write_sqlite(records: Iterable[Record], file: Path) -> None:
    file.unlink()
    columns: list[str] = []
    with sqlite3.connect(file) as base:
        base.execute("PRAGMA journal_mode = OFF")
        base.execute("CREATE TABLE results (number INTEGER PRIMARY KEY)")
        for chunk in _chunks(records):
            rows = [flat_record(record) for record in chunk]
            for name in dict.fromkeys(name for row in rows for name in row):
                if name not in columns:
                    columns.append(name)
                    base.execute(f"ALTER TABLE results ADD {_quoted(name)}")
            names = ", ".join(map(_quoted, columns))
            marks = ", ".join("?" * len(columns))
            base.executemany(
                f"INSERT INTO results ({names}) VALUES ({marks})",
                ([row.get(name) for name in columns] for row in rows),
            )
    base.close()


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'
