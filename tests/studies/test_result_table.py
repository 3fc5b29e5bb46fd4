"""Test tables of records: columns that other programs open."""

import sqlite3
from pathlib import Path
from typing import Any

import pytest

from stepaside.studies.result_table import (
    flat_record,
    to_frame,
    write_table,
)

RECORDS: list[dict[str, Any]] = [
    {"seed": 1, "x": 0.5, "touched": ["disc"], "libraries": {"numpy": "2"}},
    {"seed": 2, "x": None, "outcome": "fall", "libraries": {"numpy": "2"}},
    {"seed": 3, "x": 2, "late": True, "libraries": {"numpy": None}},
]


def test_nested_entries_are_columns_with_dots() -> None:
    assert flat_record(RECORDS[0]) == {
        "seed": 1,
        "x": 0.5,
        "touched": '["disc"]',
        "libraries.numpy": "2",
    }


def test_sqlite_has_a_row_per_record(tmp_path: Path) -> None:
    file = tmp_path / "table.sqlite"
    for _ in range(2):  # a table that is there is replaced
        write_table(iter(RECORDS), file)
    base = sqlite3.connect(file)
    rows = base.execute(
        'SELECT seed, x, outcome, "libraries.numpy" FROM results '
        "ORDER BY number"
    ).fetchall()
    base.close()
    assert rows == [
        *((1, 0.5, None, "2"), (2, None, "fall", "2"), (3, 2, None, None))
    ]


def test_parquet_is_the_frame(tmp_path: Path) -> None:
    polars = pytest.importorskip("polars")
    file = tmp_path / "table.parquet"
    write_table(iter(RECORDS), file)
    frame = polars.read_parquet(file)
    assert frame.equals(to_frame(RECORDS))
    assert frame["x"].to_list() == [0.5, None, 2.0]
    assert frame["outcome"].to_list() == [None, "fall", None]
    assert frame.columns[:3] == ["seed", "x", "touched"]


def test_no_records_are_an_empty_table(tmp_path: Path) -> None:
    pytest.importorskip("polars")
    assert to_frame([]).is_empty()
    write_table([], tmp_path / "table.parquet")
    write_table([], tmp_path / "table.sqlite")
