"""Test records on disk: complete lines of any number of writers."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from stepaside.studies.result_store import (
    RecordIndex,
    ResultStore,
    merge_stores,
)


@pytest.fixture
def store(tmp_path: Path) -> ResultStore:
    """Store with two records."""
    store = ResultStore(tmp_path / "records")
    with store.writer() as writer:
        writer.append([("a", {"x": 1.5})])
        writer.append([("b", {"x": 2.5, "none": None})])
    return store


def only_file(store: ResultStore) -> Path:
    (file,) = store.folder.iterdir()
    return file


def test_appended_records_are_read(store: ResultStore) -> None:
    assert store.read() == {"a": {"x": 1.5}, "b": {"x": 2.5, "none": None}}
    assert store.invalid_lines == {}


def test_of_two_records_with_a_key_the_last_counts(store: ResultStore) -> None:
    with store.writer() as writer:
        writer.append([("a", {"x": 3.0})])
    assert len(list(store.folder.iterdir())) == 2
    assert store.read()["a"] == {"x": 3.0}


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
def test_incomplete_and_unknown_lines_are_skipped_and_counted(
    store: ResultStore, line: str
) -> None:
    file = only_file(store)
    before = file.read_text(encoding="utf-8") + line
    file.write_text(before, encoding="utf-8")
    assert set(store.read()) == {"a", "b"}
    assert store.invalid_lines == {file: 1}
    with store.writer() as writer:
        writer.append([("c", {"x": 4.0})])
    assert set(ResultStore(store.folder).read()) == {"a", "b", "c"}
    assert file.read_text(encoding="utf-8") == before


def test_an_altered_number_is_noticed(store: ResultStore) -> None:
    file = only_file(store)
    text = file.read_text(encoding="utf-8").replace("1.5", "1.6")
    file.write_text(text, encoding="utf-8")
    assert set(store.read()) == {"b"}


def test_a_record_under_another_key_is_noticed(store: ResultStore) -> None:
    file = only_file(store)
    lines = file.read_text(encoding="utf-8").splitlines()
    entry = json.loads(lines[0]) | {"key": "z"}
    file.write_text(json.dumps(entry) + "\n", encoding="utf-8")
    assert store.read() == {}


def test_a_missing_folder_holds_nothing_and_is_not_made(
    tmp_path: Path,
) -> None:
    store = ResultStore(tmp_path / "none")
    assert store.read() == {}
    with store.writer():
        pass
    assert not store.folder.exists()


def test_an_index_tells_versions_apart(store: ResultStore) -> None:
    old = {"version": "1", "libraries": {"numpy": "2"}}
    new = {"version": "2", "libraries": {"numpy": "2"}}
    with store.writer() as writer:
        first, second = writer.append([("c", old), ("d", old | {"y": 1})])
        (third,) = writer.append([("c", new)])
    stamp_1, stamp_2 = '["1", {"numpy": "2"}]', '["2", {"numpy": "2"}]'
    index = RecordIndex(store)
    assert index.find("c", stamp_1) == first
    assert index.find("c", stamp_2) == third
    assert index.find("d", stamp_2) is None
    assert RecordIndex(store, ["y"]).find("c", stamp_2) is None
    assert RecordIndex(store, ["y"]).find("d", stamp_1) == second


def test_merging_joins_records_once(
    store: ResultStore, tmp_path: Path
) -> None:
    other = ResultStore(tmp_path / "other")
    with other.writer() as writer:
        writer.append([("a", {"x": 1.5}), ("z", {"x": 9})])
    whole = ResultStore(tmp_path / "whole")
    assert merge_stores([store, other], whole) == 3
    assert whole.read() == store.read() | other.read()
    assert merge_stores([whole, other], whole) == 3  # onto itself
    assert len(only_file(whole).read_text().splitlines()) == 3


WRITER = """
import sys
from pathlib import Path
from stepaside.studies.result_store import ResultStore
with ResultStore(Path(sys.argv[1])).writer() as writer:
    for number in range(200):
        writer.append([(f"{sys.argv[2]}/{number}", {"x": number})])
"""


def test_processes_append_at_the_same_time(tmp_path: Path) -> None:
    words = [sys.executable, "-c", WRITER, str(tmp_path)]
    writers = [subprocess.Popen([*words, str(n)]) for n in range(3)]
    assert [each.wait() for each in writers] == [0, 0, 0]
    store = ResultStore(tmp_path)
    assert len(store.read()) == 600 and not store.invalid_lines


SHORT_OF_ROOM = """
import resource, sys
from pathlib import Path
from stepaside.core.errors import OutputError
from stepaside.studies.result_store import ResultStore
store = ResultStore(Path(sys.argv[1]))
with store.writer() as writer:
    if len(sys.argv) > 2:
        writer.append([("a", {"x": 1.5})])
        size = store.files[0].stat().st_size
    else:
        size = 0
    most = size + 40  # less than a record
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
    try:
        writer.append([("c", {"x": 4.0})])
    except OutputError:
        raise SystemExit(3)
"""


@pytest.mark.parametrize("before", [["a"], []])
def test_no_partial_record_remains_on_a_full_disk(
    tmp_path: Path, before: list[str]
) -> None:
    pytest.importorskip("resource")
    words = [sys.executable, "-c", SHORT_OF_ROOM, str(tmp_path), *before]
    assert subprocess.run(words, check=False).returncode == 3
    store = ResultStore(tmp_path)
    assert list(store.read()) == before and not store.invalid_lines
    assert len(list(tmp_path.iterdir())) == len(before)
