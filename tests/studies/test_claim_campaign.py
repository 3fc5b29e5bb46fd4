"""Test the campaign of claims: verdicts, stored readings, command, page."""

import json
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli import reproduce_figures
from stepaside.cli.main import main
from stepaside.core import worker_pool as workers
from stepaside.report.claims_page import markdown_page
from stepaside.studies import claim_campaign as reproduce
from stepaside.studies.campaign import CodeStamp, code_stamp
from stepaside.studies.claim_campaign import ClaimTrial
from stepaside.studies.claim_jobs import JOBS
from stepaside.studies.claims import (
    Claim,
    ClaimJob,
    ClaimRow,
    Readings,
    most_deviating,
)
from stepaside.studies.paper_figures import paper_figures
from stepaside.studies.result_store import ResultStore

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
    row = ClaimRow("a.it", claim(relation), values, "v")
    assert row.holds is holds
    assert row.to_json()["verdict"] == ("holds" if holds else "fails")


def test_row_has_mean_spread_and_runs() -> None:
    row = ClaimRow("a.it", claim(), (1.0, 1.02, 0.98), "v").to_json()
    assert row["measured"] == pytest.approx(1.0)
    assert row["spread"] == pytest.approx(0.02)
    assert (row["least"], row["greatest"], row["runs"]) == (0.98, 1.02, 3)
    alone = ClaimRow("a.it", claim(), (1.0,), "v").to_json()
    assert (alone["spread"], alone["runs"], alone["version"]) == (0.0, 1, "v")
    fallen = ClaimRow("a.it", claim(), (1.0, NAN), "v").to_json()
    assert fallen["measured"] is fallen["spread"] is None
    assert fallen["runs"] == 2


def test_farthest_value_may_be_on_either_side() -> None:
    assert most_deviating([1.0, 0.5, 1.4], 1.0) == 0.5
    assert most_deviating([1.0, 0.9, 1.4], 1.0) == 1.4
    assert most_deviating([1.0, INF], 1.0) == INF
    assert most_deviating([], 1.0) != most_deviating([], 1.0)  # NaN


# --- stored readings ---------------------------------------------------------


class Bench:
    """Two jobs that record their measurements."""

    def __init__(self) -> None:
        self.measured: list[tuple[str, int]] = []
        self.settings = "as they are"
        self.stop_at: int | None = None
        self.jobs = {
            "seeded": self.job("seeded", ("planning",), True),
            "once": self.job("once", ("theory/unicycle",), False),
        }

    def job(
        self, name: str, modules: tuple[str, ...], seeded: bool
    ) -> ClaimJob:
        """Return a job that depends on some modules."""

        def measure(seed: int) -> Readings:
            if seed == self.stop_at:
                raise KeyboardInterrupt
            self.measured.append((name, seed))
            return {"it": 1.0 + 0.01 * seed}

        return ClaimJob(
            (claim(),),
            measure,
            modules,
            ("numpy",),
            lambda _: self.settings if seeded else "",
            seeded,
        )


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Bench:
    bench = Bench()
    monkeypatch.setattr(reproduce, "JOBS", bench.jobs)
    return bench


def again(bench: Bench, folder: Path, *seeds: int) -> list[tuple[str, int]]:
    """Run the campaign on a folder; return what it measured."""
    bench.measured.clear()
    reproduce.reproduce(ResultStore(folder), seeds)
    return sorted(bench.measured)


ALL = [("once", 0), ("seeded", 1), ("seeded", 2)]


def test_stored_reading_is_not_measured_again(
    bench: Bench, tmp_path: Path
) -> None:
    store = ResultStore(tmp_path)
    rows = reproduce.reproduce(store, (1, 2))
    assert sorted(bench.measured) == ALL
    assert [row["name"] for row in rows] == ["seeded.it", "once.it"]
    assert [row["runs"] for row in rows] == [2, 1]
    assert again(bench, tmp_path, 1, 2) == []
    assert reproduce.reproduce(store, (1, 2)) == rows
    assert again(bench, tmp_path, 1, 2, 3) == [("seeded", 3)]
    assert reproduce.reproduce(None, (1, 2)) == rows


def test_changed_module_affects_only_jobs_that_depend_on_it(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    versions = {("planning",): "a", ("theory/unicycle",): "b"}
    monkeypatch.setattr(
        reproduce,
        "code_stamp",
        lambda modules, libraries: CodeStamp(versions[modules], {}),
    )
    assert again(bench, tmp_path, 1, 2) == ALL
    versions["planning",] = "c"
    assert again(bench, tmp_path, 1, 2) == [("seeded", 1), ("seeded", 2)]
    rows = reproduce.reproduce(ResultStore(tmp_path), (1, 2))
    assert [row["version"] for row in rows] == ["c", "b"]


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
    with pytest.raises(KeyboardInterrupt):
        reproduce.reproduce(ResultStore(tmp_path), (1, 2, 3))
    assert bench.measured == [("once", 0), ("seeded", 1)]
    bench.stop_at = None
    assert again(bench, tmp_path, 1, 2, 3) == [("seeded", 2), ("seeded", 3)]


def test_missing_reading_stays_missing_and_fails(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = replace(bench.jobs["once"], measure=lambda _: {"it": NAN})
    monkeypatch.setattr(reproduce, "JOBS", {"once": job})
    for _ in range(2):
        (row,) = reproduce.reproduce(ResultStore(tmp_path), (1,))
        assert (row["verdict"], row["measured"]) == ("fails", None)


def test_worker_process_measures_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reproduce, "JOBS", {"path": JOBS["path"]})
    here = reproduce.reproduce(None, (1,))
    with ProcessPoolExecutor(1, get_context("spawn")) as executor:
        there = reproduce.reproduce(ResultStore(tmp_path), (1,), executor)
    assert there == here


def test_keys_of_a_job_are_unique() -> None:
    for name, job in JOBS.items():
        keys = [claim.key for claim in job.claims]
        assert len(set(keys)) == len(keys) > 0, name
        seeds = [reproduce.key_of(ClaimTrial(name, s)) for s in (1, 2)]
        assert seeds[0] != seeds[1]


def test_settings_of_a_physical_job_contain_seed_and_gait() -> None:
    for name in ("humanoids", "durations", "slip"):
        first, second = (JOBS[name].settings(seed) for seed in (1, 2))
        assert first != second
        assert "single_support = 0.425" in first
    assert "single_support = 0.122" in JOBS["durations"].settings(1)


# --- page and command -----------------------------------------------------

MADE = {
    "seed": 1,
    "runs": 10,
    "jobs": {
        "path": {"version": "abc", "libraries": {"numpy": "2"}},
        "com": {"version": "abc", "libraries": {"numpy": "2"}},
    },
}


def test_page_contains_values_runs_and_provenance() -> None:
    rows = [
        ClaimRow("a.it", claim(), (1.0, 1.02, 0.98), "v").to_json(),
        ClaimRow("b.it", claim("<"), (0.5,), "v").to_json(),
        ClaimRow("c.it", claim(), (NAN,), "v").to_json(),
    ]
    page = markdown_page(rows, [("2", "a|b")], [("A figure", "a.png")], MADE)
    assert "2 of 3 hold" in page
    assert "| 1 ± 0.1 | 1 ± 0.02 | 0.98 to 1.02 | 3 | m | **holds** |" in page
    assert "| &lt; 1 | 0.5 |  | 1 | m | **holds** |" in page
    assert "| none |  | 1 | m | **fails** |" in page
    assert "| 2 | a\\|b |" in page
    assert "![A figure](a.png)" in page
    assert "--seed 1 --runs 10" in page
    assert "| path, com | `abc` | numpy 2 |" in page


def test_figures_of_the_paper_are_compared_with_measurements() -> None:
    rows: list[dict[str, Any]] = [
        {"name": "circle.pursuer_radius", "measured": 2.5},
        {"name": "slip.smaller", "measured": 0.9},
        {"name": "humanoids.orientation", "measured": None},
    ]
    found = {(f.figure, f.what): f for f in paper_figures(rows, 1.5, 36.0)}
    radius = found["2", "radius of the circle"]
    assert (radius.paper, radius.source) == (
        "not given",
        "neither caption nor text",
    )
    assert (
        radius.ours == "2.500 m: 5.00 ticks, the circle is 10.0 ticks across"
    )
    assert found["2", "number of turns"].ours.startswith("1.50 of")
    assert "0.90 times" in found["6", "circle"].ours
    assert found["5", "relative orientation"].ours == "not measured"
    assert found["5", "circle"].ours == "not measured"
    one = [{"name": "humanoids.pursuer_radius", "measured": 0.65}]
    part = {(f.figure, f.what): f for f in paper_figures(one, 1.5, 36.0)}
    assert (
        part["5", "circle"].ours == "not measured"
    )  # two of three claims are missing
    assert {figure for figure, _ in found} == {"2", "5", "6"}


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
        job = JOBS["path"]
        stamp = code_stamp(job.modules, job.libraries)
        assert row["version"] == stamp.version
        assert row["verdict"] == "holds"
    stored = json.loads((tmp_path / "claims.json").read_text())
    assert stored["rows"] == rows
    assert (stored["seed"], stored["runs"]) == (1, 10)
    job = stored["jobs"]["path"]
    assert job["version"] == rows[0]["version"]
    assert "'single_support': 0.425" in job["settings"]
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
    """Also with one worker, which runs in its own process."""
    requests: list[int | None] = []

    def pool(number: int | None) -> ThreadPoolExecutor:
        requests.append(number)
        return ThreadPoolExecutor(number)

    bench.stop_at = 1
    monkeypatch.setattr(workers, "worker_pool", pool)
    call = ["reproduce", "--workers", "1", "--output", str(tmp_path)]
    result = CliRunner().invoke(main, call)
    assert (result.exit_code, requests) == (130, [1])
    assert not (tmp_path / "claims.json").exists()


def test_figures_are_drawn_once(tmp_path: Path, blank_figures: None) -> None:
    def draw() -> list[tuple[str, str]]:
        return reproduce_figures.draw_figures(
            tmp_path, 3, duration=0.5, marks=2
        )

    def times() -> dict[str, int]:
        return {name: (tmp_path / name).stat().st_mtime_ns for name in names}

    names = [name for _, name in draw()]
    assert names == ["fig2.png", "sweep.png", "duel-seed3.png"]
    for name in names:
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")
    before = times()
    draw()
    assert times() == before


def test_our_fig_2_shows_more_than_one_turn() -> None:
    turns, end = reproduce_figures.turns_shown()
    assert 1.0 < turns < 3.0
    assert end == pytest.approx(36.0)  # five time constants and one turn
