"""Test campaigns on trivial cases: same records, whatever happens."""

import os
import signal
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from stepaside.core.errors import CampaignError, ConfigurationError
from stepaside.studies import campaign as campaigns
from stepaside.studies.campaign import (
    CampaignProgress,
    CodeStamp,
    Study,
    StudyRun,
    run_study,
)
from stepaside.studies.case_grid import CaseGrid
from stepaside.studies.executors import open_engine
from stepaside.studies.records import Record
from stepaside.studies.result_store import ResultStore, merge_stores

NOW = CodeStamp("1", {"numpy": "2"})
OLD = CodeStamp("0", {"numpy": "2"})


def square(case: int) -> Record:
    return {"case": case, "square": case * case, "time_s": time.perf_counter()}


def study_of(
    cases: Any = range(12),
    measure: Callable[[int], Record] = square,
    stamp: CodeStamp = NOW,
) -> Study[int]:
    return Study(
        "squares",
        cases,
        measure,
        str,
        lambda case: stamp,
        ("square",),
        ("time_s",),
    )


def squares(run: StudyRun[int]) -> list[int]:
    return [record["square"] for record in run.records()]


EXPECTED = [n * n for n in range(12)]


def test_cases_are_measured_once(tmp_path: Path) -> None:
    store = ResultStore(tmp_path)
    told: list[CampaignProgress] = []
    first = run_study(study_of(range(5)), store)
    run = run_study(study_of(), store, None, told.append)
    assert squares(run) == EXPECTED and run.completed
    assert first.reused == 0 and run.reused == 5
    assert told[0] == (5, 5, 12) and told[-1] == (12, 5, 12)
    assert len(store.read()) == 12
    records = list(run.records())
    assert list(run_study(study_of(), store).records()) == records


@pytest.mark.parametrize("workers", [1, 3])
def test_any_executor_gives_the_same(tmp_path: Path, workers: int) -> None:
    with ThreadPoolExecutor(workers) as pool:
        run = run_study(study_of(), ResultStore(tmp_path), pool)
    assert squares(run) == EXPECTED
    assert [case for case, _ in run.items()] == list(range(12))


def test_records_of_other_versions_do_not_count(tmp_path: Path) -> None:
    store = ResultStore(tmp_path)
    run_study(study_of(stamp=OLD), store)
    run = run_study(study_of(), store)
    assert run.reused == 0 and squares(run) == EXPECTED
    assert len(list(store.entries())) == 24


def test_shards_merged_are_the_whole(tmp_path: Path) -> None:
    study = study_of()
    stores = []
    for number in (1, 2, 3):
        stores.append(ResultStore(tmp_path / str(number)))
        shard = study.shard(number, 3)
        assert len(shard.cases) == 4
        run_study(shard, stores[-1])
    whole = ResultStore(tmp_path / "all")
    merge_stores(stores, whole)
    run = StudyRun(study, whole)
    assert run.completed and squares(run) == EXPECTED


def test_a_shared_folder_needs_no_merging(tmp_path: Path) -> None:
    for number in (1, 2):
        run_study(study_of().shard(number, 2), ResultStore(tmp_path))
    assert StudyRun(study_of(), ResultStore(tmp_path)).completed


def stop_at(last: int, case: int) -> Record:
    if case == last:
        raise KeyboardInterrupt
    return square(case)


def test_ctrl_c_keeps_what_is_finished(tmp_path: Path) -> None:
    store = ResultStore(tmp_path)
    run = run_study(study_of(measure=partial(stop_at, 7)), store)
    assert run.interrupted and not run.completed
    assert squares(run) == EXPECTED[:7]
    again = run_study(study_of(), store)
    assert again.reused == 7 and squares(again) == EXPECTED


def fail_at(last: int, case: int) -> Record:
    if case == last:
        raise ZeroDivisionError(case)
    return square(case)


def test_an_error_of_a_case_is_raised_after_the_others_of_its_block(
    tmp_path: Path,
) -> None:
    store = ResultStore(tmp_path)
    with pytest.raises(ZeroDivisionError, match="11"):
        run_study(study_of(measure=partial(fail_at, 11)), store)
    assert len(store.read()) == 11


class Losing(Executor):
    """Loses some tasks, as a cluster whose scheduler starts again."""

    def __init__(self, lost: set[int]) -> None:
        self.lost, self.number = lost, 0

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run a task, or lose it."""
        future: Future[Any] = Future()
        self.number += 1
        if self.number in self.lost:
            future.cancel()
            future.set_running_or_notify_cancel()
        else:
            future.set_result(fn(*args, **kwargs))
        return future


def test_lost_blocks_are_submitted_again(tmp_path: Path) -> None:
    told: list[str] = []
    store, executor = ResultStore(tmp_path), Losing({1, 3, 4})
    run = run_study(study_of(), store, executor, None, told.append)
    assert squares(run) == EXPECTED
    assert told and all("submitted again" in message for message in told)


def test_a_block_that_is_always_lost_ends_the_campaign() -> None:
    with pytest.raises(CampaignError, match="workers were lost"):
        run_study(study_of(), None, Losing(set(range(1000))))


class Foreign(Executor):
    """Worker with another version of the package."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run a task, elsewhere."""
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs)._replace(installation="old"))
        return future


def test_a_worker_with_another_version_is_refused(tmp_path: Path) -> None:
    store = ResultStore(tmp_path)
    with pytest.raises(CampaignError, match="got old there"):
        run_study(study_of(), store, Foreign())
    assert not store.read()


def test_blocks_grow_with_short_cases_and_are_bounded(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sizes: list[int] = []
    original = campaigns.measure_block

    def counted(measure: Any, cases: Any) -> Any:
        sizes.append(len(cases))
        return original(measure, cases)

    monkeypatch.setattr(campaigns, "measure_block", counted)
    with ThreadPoolExecutor(1) as pool:
        run = run_study(study_of(range(20_000)), None, pool)
    assert run.completed and sum(sizes) == 20_000
    assert sizes[0] == 1 and 100 < max(sizes) <= campaigns.LARGEST_BLOCK


def test_a_grid_is_a_product_in_the_order_of_nested_loops() -> None:
    grid = CaseGrid("ab", range(2), (0.5,))
    items = [("a", 0, 0.5), ("a", 1, 0.5), ("b", 0, 0.5), ("b", 1, 0.5)]
    assert list(grid) == items and len(grid) == 4
    assert list(grid[1::2]) == items[1::2]
    assert list(grid[::2][1:]) == [items[2]]
    assert grid[-1] == items[-1]
    with pytest.raises(IndexError):
        grid[4]
    assert len(CaseGrid(range(1000), range(1000))) == 10**6


# --- processes ---------------------------------------------------------------


def kill_once(folder: str, case: int) -> Record:
    """End the worker process at the first attempt of a case."""
    mark = Path(folder) / "killed"
    if case == 5 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return square(case)


def test_a_killed_worker_process_is_replaced(tmp_path: Path) -> None:
    told: list[str] = []
    study = study_of(measure=partial(kill_once, str(tmp_path)))
    with open_engine("pool", 2) as engine:
        run = run_study(study, None, engine, None, told.append)
    assert squares(run) == EXPECTED
    assert told and "a worker was lost" in told[0]


def kill_always(case: int) -> Record:
    if case == 5:
        os.kill(os.getpid(), signal.SIGKILL)
    return square(case)


def test_a_case_that_kills_every_worker_ends_the_campaign(
    tmp_path: Path,
) -> None:
    store = ResultStore(tmp_path)
    with (
        pytest.raises(CampaignError, match="results are saved"),
        open_engine("pool", 1) as engine,
    ):
        run_study(study_of(measure=kill_always), store, engine)
    assert len(store.read()) >= 1


def threads(workers: int | None) -> Executor:
    return ThreadPoolExecutor(workers)


def test_a_factory_of_the_user_gives_the_executor() -> None:
    with open_engine(f"{__name__}:threads", 2) as engine:
        assert engine.workers == 2
        assert squares(run_study(study_of(), None, engine)) == EXPECTED


@pytest.mark.parametrize(
    "name",
    ["", "nothing", "pool:3", ":x", "x:", "no_such:module", "os:nothing",
     "os:getpid", "json:dumps"],
)  # fmt: skip
def test_an_unknown_executor_is_refused(name: str) -> None:
    with pytest.raises((ConfigurationError, TypeError)):
        with open_engine(name):
            pass
