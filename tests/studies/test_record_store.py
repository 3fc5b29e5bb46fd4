"""Test records on disk: whole lines or none."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from stepaside.studies.record_store import RecordStore


@pytest.fixture
def file(tmp_path: Path) -> RecordStore:
    """File with two records."""
    records = RecordStore(tmp_path / "records.jsonl")
    records.append("a", {"x": 1.5})
    records.append("b", {"x": 2.5, "none": None})
    return records


def test_appended_records_are_read(file: RecordStore) -> None:
    assert file.read() == {"a": {"x": 1.5}, "b": {"x": 2.5, "none": None}}
    assert file.aside == 0


def test_of_two_records_with_a_key_the_last_counts(file: RecordStore) -> None:
    file.append("a", {"x": 3.0})
    assert file.read()["a"] == {"x": 3.0}


@pytest.mark.parametrize(
    "line",
    [
        '{"key": "c", "check": "0", "rec',
        '{"key": "c", "check": "000000000000", "record": {}}',
        '["c"]',
        "123",
        "[" * 100_000,
        '{"key": 1, "check": 2, "record": 3}',
    ],
)
def test_incomplete_and_unknown_lines_are_set_aside(
    file: RecordStore, line: str
) -> None:
    with file.path.open("a", encoding="utf-8") as out:
        out.write(line)
    assert set(file.read()) == {"a", "b"}
    assert file.aside == 1
    aside = file.path.with_name("records.jsonl.aside")
    assert aside.read_text(encoding="utf-8") == line + "\n"
    file.append("c", {"x": 4.0})  # not glued to what was torn
    assert set(RecordStore(file.path).read()) == {"a", "b", "c"}


def test_an_altered_number_is_noticed(file: RecordStore) -> None:
    text = file.path.read_text(encoding="utf-8").replace("1.5", "1.6")
    file.path.write_text(text, encoding="utf-8")
    assert set(file.read()) == {"b"}


def test_a_record_under_another_key_is_noticed(file: RecordStore) -> None:
    lines = file.path.read_text(encoding="utf-8").splitlines()
    entry = json.loads(lines[0]) | {"key": "z"}
    file.path.write_text(json.dumps(entry) + "\n", encoding="utf-8")
    assert file.read() == {}


def test_no_file_holds_nothing_and_is_not_made(tmp_path: Path) -> None:
    file = RecordStore(tmp_path / "none.jsonl")
    assert file.read() == {}
    assert not file.path.exists()


SHORT_OF_ROOM = """
import resource, sys
from pathlib import Path
from stepaside.core.errors import OutputError
from stepaside.studies.record_store import RecordStore
file = RecordStore(Path(sys.argv[1]))
size = file.path.stat().st_size if file.path.exists() else 0
most = size + 40  # less than a record
resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
try:
    file.append("c", {"x": 4.0})
except OutputError:
    raise SystemExit(3)
"""


def test_no_partial_record_remains_on_a_full_disk(
    file: RecordStore,
) -> None:
    pytest.importorskip("resource")
    before = file.path.read_bytes()
    words = [sys.executable, "-c", SHORT_OF_ROOM, str(file.path)]
    assert subprocess.run(words, check=False).returncode == 3
    assert file.path.read_bytes() == before
    file.path.unlink()
    assert subprocess.run(words, check=False).returncode == 3
    assert not file.path.exists()
