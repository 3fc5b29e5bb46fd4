"""Test studies of trivial cases: same records, whatever happens."""

import os
import signal
import sqlite3
import sys
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from stepaside.core.errors import CampaignError, ConfigurationError
from stepaside.studies import study as studies
from stepaside.studies.study import (
    MOST_CASES,
    Study,
    StudyRun,
    merge_results,
    open_executor,
    run_study,
)
from stepaside.studies.study_design import make_study
from stepaside.studies.tabulation import Record

FILE = "squares.sqlite"
EXPECTED = [n * n for n in range(12)]


def square(case: int) -> Record:
    return {"case": case, "square": case * case, "odd": case % 2 == 1}


def study_of(
    cases: Any = range(12), measure: Callable[[int], Record] = square
) -> Study[int]:
    return Study("squares", cases, measure, str)


def squares(run: StudyRun[int]) -> list[int]:
    return [record["square"] for record in run.records()]


def table(file: Path) -> list[Any]:
    with sqlite3.connect(file) as base:
        return base.execute("SELECT * FROM results").fetchall()


def test_cases_are_measured_once(tmp_path: Path) -> None:
    told: list[Any] = []
    first = run_study(study_of(range(5)), tmp_path / FILE)
    run = run_study(
        study_of(),
        tmp_path / FILE,
        report=lambda r: told.append((r.finished, r.reused, r.total)),
    )
    assert squares(run) == EXPECTED and run.completed
    assert first.reused == 0 and run.reused == 5
    assert told[0] == (5, 5, 12) and told[-1] == (12, 5, 12)
    assert [case for case, _ in run.items()] == list(range(12))


def test_the_file_is_a_table_of_the_study_in_its_order(tmp_path: Path) -> None:
    """Cases that it no longer has are not in the table, but stay known."""
    file = tmp_path / FILE
    run_study(study_of(), file)
    assert table(file) == [(n, n * n, n % 2) for n in range(12)]
    assert run_study(study_of([7, 3]), file).reused == 2
    assert table(file) == [(7, 49, 1), (3, 9, 1)]
    assert run_study(study_of(), file).reused == 12


def test_records_are_as_measured(tmp_path: Path) -> None:
    """Names and texts with quotes, truth values, lists and None stay."""
    record = {"it's x.y": "o'c", "b": True, "n": None, "l": [1, "a"]}
    run = run_study(study_of([1], lambda case: record), tmp_path / FILE)
    assert list(run.records()) == [record]
    assert table(tmp_path / FILE) == [("o'c", 1, None, '[1,"a"]')]


def test_records_of_another_version_do_not_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run_study(study_of(), tmp_path / FILE)
    monkeypatch.setattr(studies, "RESULTS", "of another")
    assert run_study(study_of(), tmp_path / FILE).reused == 0
    monkeypatch.undo()
    assert run_study(study_of(), tmp_path / FILE).reused == 12


def test_shards_merged_are_the_whole(tmp_path: Path) -> None:
    parts = [tmp_path / f"{number}.sqlite" for number in (1, 2, 3)]
    for number, part in enumerate(parts, start=1):
        run = run_study(study_of(), part, shard=(number, 3))
        assert run.completed and run.total == 4
    assert merge_results(parts, tmp_path / "all.sqlite") == 12
    whole = StudyRun(study_of(), tmp_path / "all.sqlite")
    assert whole.reused == 12 and squares(whole) == EXPECTED
    run_study(study_of(), tmp_path / FILE)
    assert table(tmp_path / "all.sqlite") == table(tmp_path / FILE)


def stop_at(last: int, case: int) -> Record:
    if case == last:
        raise KeyboardInterrupt
    return square(case)


def test_ctrl_c_keeps_what_is_finished(tmp_path: Path) -> None:
    file = tmp_path / FILE
    run = run_study(study_of(measure=partial(stop_at, 7)), file)
    assert run.interrupted and not run.completed
    assert squares(run) == EXPECTED[:7]
    again = run_study(study_of(), file)
    assert again.reused == 7 and squares(again) == EXPECTED


def fail_at(last: int, case: int) -> Record:
    if case == last:
        raise ZeroDivisionError(case)
    return square(case)


def test_an_error_of_a_case_is_raised_after_the_others_of_its_block(
    tmp_path: Path,
) -> None:
    with pytest.raises(ZeroDivisionError, match="11"):
        run_study(study_of(measure=partial(fail_at, 11)), tmp_path / FILE)
    assert len(table(tmp_path / FILE)) == 11


def test_a_study_with_too_many_cases_is_refused() -> None:
    with pytest.raises(ConfigurationError, match=f"at most {MOST_CASES}"):
        run_study(study_of(range(10**12)))


@pytest.mark.parametrize("content", [b"no database", b"SQLite format 3\0x"])
def test_a_foreign_file_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / FILE).write_bytes(content * 100)
    with pytest.raises(ConfigurationError, match="must be a SQLite file"):
        run_study(study_of(), tmp_path / FILE)


def test_a_part_of_another_database_is_refused(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / "other.sqlite")) as base, base:
        base.execute("CREATE TABLE others (name TEXT)")
    with pytest.raises(ConfigurationError, match="no such table: records"):
        merge_results([tmp_path / "other.sqlite"], tmp_path / FILE)


def test_progress_is_shown_from_python(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("stepaside.core.progress.PERIOD", 0.0)
    run_study(study_of())
    shown = capsys.readouterr().err
    assert "squares: 100 %, 12 of 12 cases" in shown


def test_a_data_frame_has_a_row_for_each_case() -> None:
    pytest.importorskip("polars")
    frame = run_study(study_of()).to_frame()
    assert frame["square"].to_list() == EXPECTED


def test_a_missing_library_of_frames_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ModuleNotFoundError, match="pip install pandas"):
        run_study(study_of()).to_frame("pandas")


def measured(near: float, seed: int) -> Record:
    return {"closest_m": 0.2 + near + 0.1 * seed, "fell": seed == 2}


def test_a_study_prints_as_its_table_with_even_digits() -> None:
    axes = {"near": [0.0, 10.0], "seed": range(3)}
    names = ["closest_m", "fell"]
    run = run_study(make_study(measured, grid=axes, values=names))
    assert repr(run) == "StudyRun('study', 6 of 6 cases)"
    assert str(run).splitlines() == [
        "near  games  closest [m]         fell",
        "0         3   0.30 ±0.25  33 % (6-79)",
        "10        3  10.30 ±0.25  33 % (6-79)",
    ]


# --- executors ---------------------------------------------------------------


class Foreign(Executor):
    """Worker with another version of the package."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run a task, elsewhere."""
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs)._replace(results="old"))
        return future


def test_a_worker_with_another_version_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CampaignError, match="got old there"):
        run_study(study_of(), tmp_path / FILE, executor=Foreign())
    assert StudyRun(study_of(), tmp_path / FILE).finished == 0


def kill_at_first(folder: str, case: int) -> Record:
    """End the worker process at the first attempt of a case."""
    mark = Path(folder) / "killed"
    if case == 5 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return square(case)


def test_a_lost_worker_ends_the_study_and_the_next_run_completes_it(
    tmp_path: Path,
) -> None:
    study = study_of(measure=partial(kill_at_first, str(tmp_path)))
    file = tmp_path / FILE
    with pytest.raises(CampaignError, match="of 12 results are saved"):
        run_study(study, file, workers=1)
    run = run_study(study, file, workers=1)
    assert run.reused >= 1 and squares(run) == EXPECTED


@pytest.mark.slow
def test_dask_replaces_a_killed_worker(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    study = study_of(measure=partial(kill_at_first, str(tmp_path)))
    run = run_study(study, executor="dask", workers=2)
    assert squares(run) == EXPECTED
    assert (tmp_path / "killed").exists()


def threads(workers: int | None) -> Executor:
    assert workers == 2
    return ThreadPoolExecutor(workers)


def test_a_factory_of_the_user_gives_the_executor() -> None:
    run = run_study(study_of(), executor=f"{__name__}:threads", workers=2)
    assert squares(run) == EXPECTED


@pytest.mark.parametrize(
    "name",
    ["", "nothing", "processes:3", ":x", "x:", "no_such:module", "os:nothing",
     "os:getpid", "json:dumps"],
)  # fmt: skip
def test_an_unknown_executor_is_refused(name: str) -> None:
    with pytest.raises((ConfigurationError, TypeError)):
        with open_executor(name):
            pass
