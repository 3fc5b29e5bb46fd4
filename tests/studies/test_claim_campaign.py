"""Test the campaign of claims: verdicts, stored readings, command, page."""

import json
from concurrent.futures import (
    Executor,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli import reproduce_figures
from stepaside.cli.main import main
from stepaside.core import worker_pool as workers
from stepaside.studies import claim_campaign as reproduce
from stepaside.studies.claim_jobs import JOBS
from stepaside.studies.claims import (
    Claim,
    ClaimJob,
    ClaimRow,
    Readings,
)
from stepaside.studies.results_version import RESULTS
from stepaside.studies.study import run_study

NAN, INF = float("nan"), float("inf")


def claim(relation: Any = "=", key: str = "it") -> Claim:
    return Claim(key, "it is one", "I", "paper", 1.0, "m", 0.1, relation)


@pytest.mark.parametrize(
    ("relation", "values", "holds"),
    [
        ("=", (1.05,), True),
        ("=", (1.15,), False),
        ("=", (0.85,), False),
        ("=", (-5.0,), False),
        ("=", (1.15, 0.95), True),  # the mean is within the tolerance
        ("=", (1.25, 0.75), False),  # single runs are too far off
        ("=", (0.75, 1.19), False),
        ("=", (1.12, 1.12), False),
        ("<", (0.9, 0.99), True),
        ("<", (0.5, 1.01), False),
        ("<", (1.0,), False),
        (">", (1.1, 9.0), True),
        (">", (9.0, 0.99), False),
        ("=", (1.0, NAN), False),
        ("<", (0.0, -INF), False),
        ("=", (), False),
    ],
)
def test_verdict(
    relation: Any, values: tuple[float, ...], holds: bool
) -> None:
    row = ClaimRow("a.it", claim(relation), values)
    assert row.holds is holds
    assert row.to_json()["verdict"] == ("holds" if holds else "fails")


# --- stored readings ---------------------------------------------------------


class Bench:
    """Two jobs that record their measurements."""

    def __init__(self) -> None:
        self.measured: list[tuple[str, int]] = []
        self.settings = "as they are"
        self.stop_at: int | None = None
        self.jobs = {
            "seeded": self.job("seeded", True),
            "once": self.job("once", False),
        }

    def job(self, name: str, seeded: bool) -> ClaimJob:
        """Return a job that notes its measurements."""

        def measure(seed: int) -> Readings:
            if seed == self.stop_at:
                raise KeyboardInterrupt
            self.measured.append((name, seed))
            return {"it": 1.0 + 0.01 * seed}

        return ClaimJob(
            (claim(),),
            measure,
            lambda _: self.settings if seeded else "",
            seeded,
        )


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Bench:
    bench = Bench()
    monkeypatch.setattr(reproduce, "JOBS", bench.jobs)
    return bench


def rows_of(
    file: Path | None, seeds: tuple[int, ...], executor: Executor | None = None
) -> list[Any]:
    study = reproduce.claim_study(seeds)
    return reproduce.claim_rows(run_study(study, file, executor=executor))


def again(bench: Bench, folder: Path, *seeds: int) -> list[tuple[str, int]]:
    """Run the campaign on a folder; return what it measured."""
    bench.measured.clear()
    run_study(reproduce.claim_study(seeds), folder / "kept.sqlite")
    return sorted(bench.measured)


ALL = [("once", 0), ("seeded", 1), ("seeded", 2)]


def test_stored_reading_is_not_measured_again(
    bench: Bench, tmp_path: Path
) -> None:
    store = tmp_path / "kept.sqlite"
    rows = rows_of(store, (1, 2))
    assert sorted(bench.measured) == ALL
    assert [row["name"] for row in rows] == ["seeded.it", "once.it"]
    assert [row["runs"] for row in rows] == [2, 1]
    assert again(bench, tmp_path, 1, 2) == []
    assert rows_of(store, (1, 2)) == rows
    assert again(bench, tmp_path, 1, 2, 3) == [("seeded", 3)]
    assert rows_of(None, (1, 2)) == rows


def test_changed_settings_are_measured_again(
    bench: Bench, tmp_path: Path
) -> None:
    assert again(bench, tmp_path, 1, 2) == ALL
    bench.settings = "others"
    assert again(bench, tmp_path, 1, 2) == [("seeded", 1), ("seeded", 2)]
    assert again(bench, tmp_path, 1, 2) == []


def test_interrupted_campaign_keeps_finished_readings(
    bench: Bench, tmp_path: Path
) -> None:
    bench.stop_at = 2
    assert again(bench, tmp_path, 1, 2, 3) == [("once", 0), ("seeded", 1)]
    bench.stop_at = None
    assert again(bench, tmp_path, 1, 2, 3) == [("seeded", 2), ("seeded", 3)]


def test_missing_reading_stays_missing_and_fails(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = replace(bench.jobs["once"], measure=lambda _: {"it": NAN})
    monkeypatch.setattr(reproduce, "JOBS", {"once": job})
    for _ in range(2):
        (row,) = rows_of(tmp_path / "kept.sqlite", (1,))
        assert (row["verdict"], row["measured"]) == ("fails", None)


def test_worker_process_measures_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reproduce, "JOBS", {"path": JOBS["path"]})
    here = rows_of(None, (1,))
    with ProcessPoolExecutor(1, get_context("spawn")) as executor:
        there = rows_of(tmp_path / "kept.sqlite", (1,), executor)
    assert there == here


# --- page and command -----------------------------------------------------


def test_command_prints_rows_and_writes_the_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reproduce, "JOBS", {"path": JOBS["path"]})
    monkeypatch.setattr(workers, "worker_pool", ThreadPoolExecutor)
    monkeypatch.setattr(reproduce_figures, "draw_figures", lambda *_: [])
    call = ["reproduce", "--workers", "1", "--output", str(tmp_path)]
    result = CliRunner().invoke(main, [*call, "--json"])
    assert result.exit_code == 0, result.stderr
    rows = json.loads(result.stdout)
    assert len(rows) == len(JOBS["path"].claims)
    for row in rows:
        assert row["measured"] is not None
        assert (row["runs"], row["spread"]) == (1, 0.0)
        assert row["verdict"] == "holds"
    stored = json.loads((tmp_path / "claims.json").read_text())
    assert stored["rows"] == rows
    assert (stored["seed"], stored["runs"]) == (1, 10)
    assert stored["results"] == RESULTS
    assert "'single_support': 0.425" in stored["settings"]["path"]
    html = (tmp_path / "claims.html").read_text()
    first = html.split("</table>")[0]
    assert first.count("<tr>") == len(rows) + 1
    assert first.count("<td") == 10 * len(rows)  # bars do not split cells
    assert "|theta*|" in html
    text = CliRunner().invoke(main, call)
    assert f"{len(rows)} of {len(rows)} hold" in text.stdout


@pytest.mark.parametrize(
    ("value", "status"), [(1.0, 0), (NAN, 1)], ids=["holds", "fails"]
)
@pytest.mark.parametrize("as_json", [True, False])
def test_exit_status_is_0_if_every_claim_holds_else_1(
    bench: Bench,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    value: float,
    status: int,
    as_json: bool,
) -> None:
    job = replace(bench.jobs["once"], measure=lambda _: {"it": value})
    bench.jobs["once"] = job
    monkeypatch.setattr(workers, "worker_pool", ThreadPoolExecutor)
    monkeypatch.setattr(reproduce_figures, "draw_figures", lambda *_: [])
    call = ["reproduce", "--runs", "1", "--output", str(tmp_path)]
    result = CliRunner().invoke(main, [*call, *["--json"] * as_json])
    assert result.exit_code == status, result.output
    if as_json:
        assert len(json.loads(result.stdout)) == 2
    else:
        assert f"{2 - status} of 2 hold" in result.stdout
    assert (tmp_path / "claims.html").exists()


def test_interrupt_ends_worker_processes_with_status_130(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    requests: list[int | None] = []

    def pool(number: int | None) -> ThreadPoolExecutor:
        requests.append(number)
        return ThreadPoolExecutor(number)

    bench.stop_at = 1
    monkeypatch.setattr(workers, "worker_pool", pool)
    call = ["reproduce", "--workers", "2", "--output", str(tmp_path)]
    result = CliRunner().invoke(main, call)
    assert (result.exit_code, requests) == (130, [2])
    assert not (tmp_path / "claims.json").exists()
